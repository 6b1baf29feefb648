// SPDX-License-Identifier: GPL-3.0-or-later

// A patient from DICOM to the difference between two predictions. The patient is a synthetic one whose truth is known.
//
// usage: 03_patient FOLDER     FOLDER: where the patient's files go; exit code 0 if the measured stiffness is right
#include <cmath>
#include <cstdio>
#include <filesystem>

#include "base/error.h"
#include "phantom/phantom.h"
#include "pipeline/run.h"
#include "pipeline/scene.h"

int main(int argc, char** argv) {
  using namespace glisson;
  if (argc != 2) {
    std::fprintf(stderr, "usage: 03_patient FOLDER\n");
    return 2;
  }
  const std::filesystem::path folder = argv[1];
  try {
    // 1. Six series of DICOM files, an RT Structure Set, scene.json and truth.json, as `glisson-cli phantom` writes
    // them.
    phantom::PhantomOptions options;
    options.shear_kPa = 4.5;
    const phantom::PhantomPatient patient = phantom::makePhantom(3, options);
    phantom::writePhantom(patient, folder);

    // 2. The patient's scene, with coarse cells and a bar that travels 20 mm, so that it takes seconds.
    pipeline::Scene scene = pipeline::readScene(folder / "scene.json");
    scene.geometry.cell_mm.setConstant(8.0);
    for (retraction::LoadSpec& load : scene.setup.loads)
      if (auto* bar = std::get_if<retraction::Retractor>(&load)) {
        bar->force_N.reset();
        bar->travel_mm = 20.0;
      }
    scene.outputs = {};
    scene.outputs.vessels = true;

    // 3. What would be computed, and what not.
    for (const pipeline::PlanStep& step : pipeline::plan(scene))
      if (step.needed) std::printf("  %s\n", step.step.c_str());

    // 4. Everything the plan says; results in memory, nothing written.
    const pipeline::RunResult run = pipeline::run(scene, {});
    for (const std::string& text : run.diagnostics.texts(Severity::Warning)) std::printf("%s\n", text.c_str());
    const double measured_kPa = run.stiffness->pooled.mean_kPa;
    std::printf("shear modulus %.3f kPa measured, %.3f true\n", measured_kPa, patient.truth.shear_kPa);
    std::printf("%d unknowns, %zu vessel landmarks\n", run.primary.dofs, run.landmarks_mm.size());
    if (run.difference)
      std::printf("difference: mean %.2f mm, at the retractor %.2f mm\n", run.difference->mean_mm,
                  run.difference->at_retractor_mm);
    const bool right = std::abs(measured_kPa / patient.truth.shear_kPa - 1) < 0.01;
    return right && run.primary.solver.converged() && run.difference ? 0 : 1;
  } catch (const Error& error) {
    // Every error that Glisson throws on purpose says what to do about it.
    std::fprintf(stderr, "03_patient: %s\n", error.what());
    return 1;
  }
}
