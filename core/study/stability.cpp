// SPDX-License-Identifier: GPL-3.0-or-later
#include "study/stability.h"

#include "base/error.h"
#include "study/detail/stability_cases.h"
#include "study/detail/timing.h"

namespace glisson::study {

Outcome refused(const std::function<void()>& act, const std::vector<std::string>& needles) {
  Outcome o;
  o.refusal = true;
  try {
    act();
    o.detail = "was accepted";
  } catch (const BadInput& e) {
    o.detail = e.what();
    o.good = true;
    for (const std::string& needle : needles)
      if (o.detail.find(needle) == std::string::npos) {
        o.good = false;
        o.detail = "refused, but without saying \"" + needle + "\": " + e.what();
        break;
      }
  }
  return o;
}

mechanics::VoxelBody solidBox(const Eigen::Vector3i& cells, const Eigen::Vector3d& size_m, double E_Pa,
                              double poisson) {
  mechanics::VoxelBody body;
  body.cells = cells;
  body.h_m = size_m.cwiseQuotient(cells.cast<double>());
  body.E_Pa.assign(static_cast<std::size_t>(cells.prod()), E_Pa);
  body.poisson = poisson;
  return body;
}

void paint(mechanics::VoxelBody& body, const std::function<double(const Eigen::Vector3d&)>& E_Pa) {
  for (int k = 0; k < body.cells.z(); ++k)
    for (int j = 0; j < body.cells.y(); ++j)
      for (int i = 0; i < body.cells.x(); ++i)
        body.E_Pa[body.cell(i, j, k)] = E_Pa(Eigen::Vector3d(i + 0.5, j + 0.5, k + 0.5).cwiseProduct(body.h_m));
}

std::vector<int> nodesWhere(const mechanics::VoxelMesh& mesh,
                            const std::function<bool(const Eigen::Vector3d&)>& chosen) {
  std::vector<int> nodes;
  for (int n = 0; n < mesh.nodeCount(); ++n)
    if (chosen(mesh.position_m(n))) nodes.push_back(n);
  return nodes;
}

std::vector<mechanics::Face> facesOn(const mechanics::VoxelMesh& mesh, int side) {
  std::vector<mechanics::Face> faces;
  const int axis = side / 2, wanted = side % 2 ? mesh.cells()[axis] - 1 : 0;
  for (const mechanics::Face& f : mechanics::exteriorFaces(mesh))
    if (f.side == side && mesh.cellOf(f.filledCell)[axis] == wanted) faces.push_back(f);
  return faces;
}

std::vector<mechanics::Fixation> clampSide(const mechanics::VoxelMesh& mesh, int side,
                                           const std::array<bool, 3>& axis) {
  return mechanics::fix(mechanics::nodesOfFaces(mesh, facesOn(mesh, side)), axis);
}

double relativeDifference(const mechanics::NodalField& a, const mechanics::NodalField& b) {
  const double size = b.cwiseAbs().maxCoeff();
  return (a - b).cwiseAbs().maxCoeff() / (size > 0 ? size : 1.0);
}

std::vector<StabilityCase> stabilitySweep(const StabilityOptions& options, const Progress& progress) {
  Scenes scenes;
  for (const auto& group : {motionScenes, bendingScenes, contrastScenes, matrixScenes, meshScenes, refusalScenes,
                            retractionScenes, contactScenes})
    for (ExtremeScene& s : group(options)) scenes.push_back(std::move(s));
  std::vector<StabilityCase> cases;
  for (const ExtremeScene& s : scenes) {
    const double n = static_cast<double>(scenes.size());
    const Progress part =
        progress.part(static_cast<double>(cases.size()) / n, static_cast<double>(cases.size() + 1) / n);
    part.report(0.0, s.name);
    StabilityCase c;
    c.name = s.name;
    c.expectation = s.expectation;
    const Stopwatch watch;
    try {
      const Outcome o = s.run(Progress([&part](double, const std::string&) { part.check(); }));
      c.verdict = !o.good ? "fail" : o.refusal ? "refused as expected" : "pass";
      c.iterations = o.iterations;
      c.residual = o.residual;
      c.detail = o.detail;
    } catch (const Cancelled&) {
      throw;
    } catch (const std::exception& e) {
      c.verdict = "fail";
      c.detail = std::string("threw: ") + e.what();
    }
    c.seconds = watch.seconds();
    cases.push_back(std::move(c));
  }
  progress.report(1.0, "sweep done");
  return cases;
}

bool allAsExpected(const std::vector<StabilityCase>& cases) {
  return std::none_of(cases.begin(), cases.end(), [](const StabilityCase& c) { return c.verdict == "fail"; });
}

}  // namespace glisson::study
