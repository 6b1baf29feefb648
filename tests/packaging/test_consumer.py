# SPDX-License-Identifier: GPL-3.0-or-later
"""Another project finds the installed libraries with find_package(Glisson), links one room, and gets a right answer."""
import os
import pathlib
import re
import subprocess
import tempfile
import unittest

from support import ROOT

BUILD = os.environ["GLISSON_BUILD"]
CMAKE = os.environ["GLISSON_CMAKE"]

PROJECT = """cmake_minimum_required(VERSION 3.25)
project(Consumer LANGUAGES C CXX)
set(CMAKE_CXX_STANDARD 20)
find_package(Glisson 0.1 REQUIRED)
add_executable(consumer main.cpp)
target_link_libraries(consumer PRIVATE Glisson::base Glisson::mechanics)
"""

# A bar that hangs by its own weight: at its end rho g L^2 / (2 E), with Poisson's ratio 0.
PROGRAM = """#include <cstdio>
#include "base/version.h"
#include "mechanics/static_solve.h"
int main() {
  using namespace glisson::mechanics;
  Problem p;
  p.body.cells = {2, 2, 10};
  p.body.h_m = {0.005, 0.005, 0.005};
  p.body.E_Pa.assign(40, 12000.0);
  p.body.poisson = 0.0;
  const VoxelMesh mesh(p.body);
  p.f_N = NodalField::Zero(3, mesh.nodeCount());
  const double weight_N = 1060.0 * 9.81 * 0.005 * 0.005 * 0.005;
  for (int e = 0; e < mesh.cellCount(); ++e)
    for (int n : mesh.nodesOf(e)) p.f_N(2, n) += weight_N / 8;
  for (int n = 0; n < mesh.nodeCount(); ++n)
    if (mesh.latticeOf(n).z() == 0) p.supports.fixations.push_back({n, {true, true, true}, {0, 0, 0}});
  const Solution s = solveStatic(p);
  std::printf("%s %.6f\\n", glisson::version().c_str(), 1e3 * s.u_m.row(2).maxCoeff());
  return s.report.converged() ? 0 : 1;
}
"""


class Consumer(unittest.TestCase):
    def test_the_installed_libraries_can_be_linked(self):
        with tempfile.TemporaryDirectory() as folder:
            folder = pathlib.Path(folder)
            prefix = folder / "prefix"
            subprocess.run([CMAKE, "--install", BUILD, "--component", "dev", "--prefix", prefix], check=True, capture_output=True)
            for config in prefix.rglob("GlissonTargets*.cmake"):
                self.assertNotIn(BUILD, config.read_text(), "no path of the build stays in what is installed")
            (folder / "CMakeLists.txt").write_text(PROJECT)
            (folder / "main.cpp").write_text(PROGRAM)
            for command in ([CMAKE, "-S", folder, "-B", folder / "b", "-G", "Ninja", f"-DCMAKE_PREFIX_PATH={prefix}"],
                            [CMAKE, "--build", folder / "b"]):
                done = subprocess.run(command, capture_output=True, text=True)
                self.assertEqual(done.returncode, 0, done.stdout[-2000:] + done.stderr[-2000:])
            said = subprocess.run([folder / "b/consumer"], capture_output=True, text=True, check=True).stdout.split()
        version = re.search(r"project\(Glisson VERSION (\S+)", (ROOT / "CMakeLists.txt").read_text()).group(1)
        self.assertEqual(said[0], version)
        # 1060 * 9.81 * 0.05^2 / (2 * 12000) m; held across at its root, where nothing pulls with Poisson's ratio 0.
        self.assertAlmostEqual(float(said[1]), 1.083188, places=5)


if __name__ == "__main__":
    unittest.main()
