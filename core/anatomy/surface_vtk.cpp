// SPDX-License-Identifier: GPL-3.0-or-later

// Legacy VTK and VTK XML files, through VTK's readers.
#include <vtkCellArray.h>
#include <vtkCellTypes.h>
#include <vtkDataSetSurfaceFilter.h>
#include <vtkFieldData.h>
#include <vtkGenericDataObjectReader.h>
#include <vtkLogger.h>
#include <vtkNew.h>
#include <vtkObjectFactory.h>
#include <vtkOutputWindow.h>
#include <vtkPolyData.h>
#include <vtkStringArray.h>
#include <vtkTriangleFilter.h>
#include <vtkUnstructuredGrid.h>
#include <vtkXMLPolyDataReader.h>
#include <vtkXMLUnstructuredGridReader.h>

#include <algorithm>
#include <mutex>
#include <new>

#include "anatomy/detail/surface_formats.h"

namespace glisson::anatomy::detail {
namespace {

/// While it lives, what VTK's readers say is kept rather than written to the terminal.
class Quiet {
 public:
  Quiet() : lock_(mutex()), before_(vtkOutputWindow::GetInstance()), loud_(vtkLogger::GetCurrentVerbosityCutoff()) {
    vtkOutputWindow::SetInstance(window_);
    vtkLogger::SetStderrVerbosity(vtkLogger::VERBOSITY_OFF);
  }
  ~Quiet() {
    vtkLogger::SetStderrVerbosity(loud_);
    vtkOutputWindow::SetInstance(before_);
  }
  Quiet(const Quiet&) = delete;
  Quiet& operator=(const Quiet&) = delete;
  const std::string& said() const { return window_->text; }

 private:
  class Window : public vtkOutputWindow {
   public:
    static Window* New();
    vtkTypeMacro(Window, vtkOutputWindow);
    void DisplayText(const char* t) override {
      if (t && text.size() < 400) text += t;
    }
    void DisplayErrorText(const char* t) override { DisplayText(t); }
    std::string text;
  };
  static std::mutex& mutex() {
    static std::mutex m;
    return m;
  }
  std::lock_guard<std::mutex> lock_;
  vtkSmartPointer<vtkOutputWindow> before_;
  vtkNew<Window> window_;
  vtkLogger::Verbosity loud_;
};
vtkStandardNewMacro(Quiet::Window);

bool saysRas(vtkDataSet* data) {
  auto* space = vtkStringArray::SafeDownCast(data->GetFieldData()->GetAbstractArray("SPACE"));
  return space && space->GetNumberOfValues() > 0 && space->GetValue(0) == "RAS";
}

/// VTK's filters trust the indices of a file; a file need not.
void checkCells(const std::filesystem::path& path, vtkCellArray* cells, vtkIdType points) {
  if (!cells) return;
  const vtkIdType all = cells->GetNumberOfConnectivityIds();
  vtkDataArray* offsets = cells->GetOffsetsArray();
  for (vtkIdType c = 0; c + 1 < offsets->GetNumberOfTuples(); ++c) {
    const double begin = offsets->GetComponent(c, 0), end = offsets->GetComponent(c + 1, 0);
    if (begin < 0 || end < begin || end > static_cast<double>(all))
      refuseSurface(path, "its list of cells contradicts itself");
  }
  vtkDataArray* ids = cells->GetConnectivityArray();
  for (vtkIdType i = 0; i < all; ++i) {
    const double id = ids->GetComponent(i, 0);
    if (!(id >= 0 && id < static_cast<double>(points))) refuseSurface(path, "a cell names a point that is not there");
  }
}

template <class Reader>
vtkSmartPointer<vtkDataSet> readWith(const std::filesystem::path& path) {
  vtkNew<Reader> reader;
  reader->SetFileName(path.c_str());
  reader->Update();
  return vtkDataSet::SafeDownCast(reader->GetOutputDataObject(0));
}

vtkSmartPointer<vtkDataSet> dataOf(const std::filesystem::path& path, bool xml, bool volume) {
  Quiet quiet;
  vtkSmartPointer<vtkDataSet> data;
  try {
    data = !xml     ? readWith<vtkGenericDataObjectReader>(path)
           : volume ? readWith<vtkXMLUnstructuredGridReader>(path)
                    : readWith<vtkXMLPolyDataReader>(path);
  } catch (const std::bad_alloc&) {
    refuseSurface(path, "it announces more data than memory holds");
  }
  if (!quiet.said().empty()) {
    std::string why = quiet.said().substr(0, quiet.said().find('\n'));
    const auto colon = quiet.said().rfind("): ");
    if (colon != std::string::npos) why = quiet.said().substr(colon + 3);
    why.erase(std::min(why.find('\n'), why.size()));
    refuseSurface(path, "its reader says: " + why);
  }
  if (!data || data->GetNumberOfPoints() == 0) refuseSurface(path, "it holds no points");
  return data;
}

}  // namespace

SurfaceFile readVtk(const std::filesystem::path& path, bool xml, bool volumeFile) {
  SurfaceFile out;
  if (!xml) checkLegacyVtk(path);
  const vtkSmartPointer<vtkDataSet> data = dataOf(path, xml, volumeFile);
  vtkSmartPointer<vtkPolyData> surface = vtkPolyData::SafeDownCast(data);
  out.points = static_cast<std::size_t>(data->GetNumberOfPoints());
  if (auto* volume = vtkUnstructuredGrid::SafeDownCast(data)) {
    checkCells(path, volume->GetCells(), volume->GetNumberOfPoints());
    for (vtkIdType c = 0; c < volume->GetNumberOfCells(); ++c) {
      const int type = volume->GetCellType(c);
      out.volumeCells += type == VTK_TETRA || type == VTK_HEXAHEDRON || type == VTK_WEDGE || type == VTK_PYRAMID ||
                         type == VTK_QUADRATIC_TETRA || type == VTK_VOXEL;
    }
    vtkNew<vtkDataSetSurfaceFilter> outside;
    outside->SetInputData(volume);
    outside->Update();
    surface = outside->GetOutput();
  }
  if (!surface) refuseSurface(path, "it holds neither polygons nor cells");
  for (vtkCellArray* cells : {surface->GetPolys(), surface->GetStrips()})
    checkCells(path, cells, surface->GetNumberOfPoints());
  vtkNew<vtkTriangleFilter> cut;
  cut->SetInputData(surface);
  cut->PassLinesOff();
  cut->PassVertsOff();
  cut->Update();
  vtkPolyData* t = cut->GetOutput();
  out.mesh.vertices_lps_mm.resize(3, t->GetNumberOfPoints());
  for (vtkIdType i = 0; i < t->GetNumberOfPoints(); ++i) t->GetPoint(i, out.mesh.vertices_lps_mm.col(i).data());
  out.mesh.triangles.resize(3, t->GetNumberOfPolys());
  vtkIdType size = 0;
  const vtkIdType* ids = nullptr;
  vtkCellArray* polys = t->GetPolys();
  polys->InitTraversal();
  for (vtkIdType c = 0; polys->GetNextCell(size, ids); ++c)
    for (int a = 0; a < 3; ++a) out.mesh.triangles(a, c) = static_cast<int>(ids[a]);
  if (saysRas(data)) {
    out.mesh.vertices_lps_mm.topRows(2) *= -1.0;
    out.warnings.emplace_back("its coordinates are RAS; they were turned into LPS");
  }
  return out;
}

}  // namespace glisson::anatomy::detail
