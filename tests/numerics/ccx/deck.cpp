// SPDX-License-Identifier: GPL-3.0-or-later
#include "deck.h"

#include <cstdlib>
#include <fstream>
#include <map>
#include <sstream>
#include <stdexcept>

#include "support/support.h"

namespace glisson::ccx {
namespace {

void write(const Deck& deck, std::ostream& out) {
  out.precision(17);
  out << "*NODE, NSET=NALL\n";
  for (Eigen::Index i = 0; i < deck.nodes_m.cols(); ++i)
    out << i + 1 << ", " << deck.nodes_m(0, i) << ", " << deck.nodes_m(1, i) << ", " << deck.nodes_m(2, i) << "\n";
  std::map<double, std::vector<Eigen::Index>> byModulus;
  for (Eigen::Index e = 0; e < deck.elements.cols(); ++e) byModulus[deck.E_Pa[e]].push_back(e);
  int set = 0;
  for (const auto& [E, members] : byModulus) {
    ++set;
    out << "*ELEMENT, TYPE=" << deck.element << ", ELSET=E" << set << "\n";
    for (const Eigen::Index e : members) {
      out << e + 1;
      for (const int node : deck.elements.col(e)) out << ", " << node + 1;
      out << "\n";
    }
  }
  // Density 1 and an acceleration of the force's size.
  const double size = deck.force_N_m3.norm();
  const Eigen::Vector3d along = deck.force_N_m3 / size;
  std::ostringstream loads;
  loads.precision(17);
  set = 0;
  for (const auto& [E, members] : byModulus) {
    ++set;
    out << "*MATERIAL, NAME=M" << set << "\n*ELASTIC\n" << E << ", " << deck.poisson << "\n*DENSITY\n1.\n";
    out << "*SOLID SECTION, ELSET=E" << set << ", MATERIAL=M" << set << "\n";
    loads << "E" << set << ", GRAV, " << size << ", " << along.x() << ", " << along.y() << ", " << along.z() << "\n";
  }
  out << "*BOUNDARY\n";
  for (const mechanics::Fixation& f : deck.fixations)
    for (int c = 0; c < 3; ++c)
      if (f.axis[static_cast<std::size_t>(c)])
        out << f.node + 1 << ", " << c + 1 << ", " << c + 1 << ", " << f.value_m[c] << "\n";
  out << "*STEP" << (deck.largeDeformation ? ", NLGEOM, INC=1000" : "") << "\n*STATIC\n"
      << (deck.largeDeformation ? "0.1, 1.\n" : "") << "*DLOAD\n"
      << loads.str() << "*NODE PRINT, NSET=NALL, FREQUENCY=1000\nU\n*END STEP\n";
}

}  // namespace

bool installed() {
  return std::system("command -v ccx > /dev/null 2>&1") == 0;
}

mechanics::NodalField run(const Deck& deck) {
  const test::TemporaryFolder folder;
  {
    std::ofstream file(folder / "deck.inp");
    write(deck, file);
    if (!file) throw std::runtime_error("the deck could not be written");
  }
  const std::string command =
      "cd '" + folder.path().string() + "' && OMP_NUM_THREADS=1 OPENBLAS_NUM_THREADS=1 ccx -i deck > deck.log 2>&1";
  if (std::system(command.c_str()) != 0) {
    std::ifstream log(folder / "deck.log");
    std::ostringstream text;
    text << log.rdbuf();
    throw std::runtime_error("ccx failed: " + text.str());
  }
  std::ifstream file(folder / "deck.dat");
  mechanics::NodalField u = mechanics::NodalField::Zero(3, deck.nodes_m.cols());
  std::vector<char> seen(static_cast<std::size_t>(u.cols()), 0);
  for (std::string line; std::getline(file, line);) {
    std::istringstream words(line);
    long node = 0;
    Eigen::Vector3d value;
    if (words >> node >> value[0] >> value[1] >> value[2] && node >= 1 && node <= u.cols()) {
      u.col(node - 1) = value;  // the last increment printed stays
      seen[static_cast<std::size_t>(node - 1)] = 1;
    }
  }
  for (std::size_t i = 0; i < seen.size(); ++i)
    if (seen[i] == 0) throw std::runtime_error("ccx printed no displacement of node " + std::to_string(i + 1));
  return u;
}

}  // namespace glisson::ccx
