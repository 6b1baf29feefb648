#include "views/bar_actor.h"

#include <vtkActor.h>
#include <vtkCylinderSource.h>
#include <vtkPolyDataMapper.h>
#include <vtkProperty.h>
#include <vtkTransform.h>

#include <Eigen/Geometry>

namespace glisson::views {

BarActor::BarActor(const tools::BarPlace& place) {
  vtkNew<vtkCylinderSource> cylinder;  // along y
  cylinder->SetRadius(0.5 * place.diameter_mm);
  cylinder->SetHeight(place.length_mm);
  cylinder->SetResolution(32);
  vtkNew<vtkPolyDataMapper> mapper;
  mapper->SetInputConnection(cylinder->GetOutputPort());
  actor_->SetMapper(mapper);
  actor_->GetProperty()->SetColor(0.80, 0.82, 0.85);
  actor_->GetProperty()->SetSpecular(0.5);
  actor_->SetUserTransform(transform_);
  frame_.topLeftCorner<3, 3>() =
      Eigen::Quaterniond::FromTwoVectors(Eigen::Vector3d::UnitY(), place.axis).toRotationMatrix();
  // It lies against the liver on the side that the hoist comes from.
  frame_.topRightCorner<3, 1>() = place.contact_lps - 0.5 * place.diameter_mm * place.direction.normalized();
  shift(Eigen::Vector3d::Zero());
}

BarActor::~BarActor() = default;

void BarActor::shift(const Eigen::Vector3d& by_mm) {
  Eigen::Matrix<double, 4, 4, Eigen::RowMajor> at = frame_;
  at.topRightCorner<3, 1>() += by_mm;
  transform_->SetMatrix(at.data());
}

}  // namespace glisson::views
