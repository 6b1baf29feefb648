// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cstring>
#include <fstream>
#include <sstream>

#include "dicom/detail/siemens.h"
#include "said.h"

namespace glisson::dicom {
namespace {

using testing::HasSubstr;

/// The parts of a NIfTI-1 file that the comparison needs, read without the image room.
struct Nifti {
  std::array<std::int16_t, 8> dim{};
  float slope = 1.0F, intercept = 0.0F;
  Eigen::Matrix<double, 3, 4> affine_ras;
  std::vector<std::uint16_t> values;
  float at(int i, int j, int k) const {
    return slope * static_cast<float>(values[static_cast<std::size_t>(i + dim[1] * (j + dim[2] * k))]) + intercept;
  }
};

Nifti readNifti(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  std::ostringstream all;
  all << in.rdbuf();
  const std::string b = all.str();
  Nifti n;
  std::memcpy(n.dim.data(), b.data() + 40, 16);
  float offset = 0.0F;
  std::memcpy(&offset, b.data() + 108, 4);
  std::memcpy(&n.slope, b.data() + 112, 4);
  std::memcpy(&n.intercept, b.data() + 116, 4);
  for (int r = 0; r < 3; ++r)
    for (int c = 0; c < 4; ++c) {
      float value = 0.0F;
      std::memcpy(&value, b.data() + 280 + 16 * r + 4 * c, 4);
      n.affine_ras(r, c) = static_cast<double>(value);
    }
  n.values.resize(static_cast<std::size_t>(n.dim[1] * n.dim[2] * n.dim[3]));
  std::memcpy(n.values.data(), b.data() + static_cast<std::size_t>(offset), 2 * n.values.size());
  return n;
}

TEST(Mosaics, voxelsAndPlacesAreThoseOfTheIndependentNifti) {
  GLISSON_NEEDS_DATA("siemens_mre_phase");
  const auto folder = test::sharedData() / "siemens_mre_phase";
  const ScanResult found = scan(folder / "phase_046");
  ASSERT_EQ(found.series.size(), 24U);
  std::vector<std::filesystem::path> niftis;
  for (const auto& e : std::filesystem::directory_iterator(folder / "nifti_spm"))
    if (e.path().extension() == ".nii") niftis.push_back(e.path());
  std::sort(niftis.begin(), niftis.end());
  ASSERT_EQ(niftis.size(), 8U);
  for (std::size_t n = 0; n < 8; ++n) {  // the first direction
    const Series& s = found.series[n];
    ASSERT_FALSE(s.error) << *s.error;
    const image::ScalarVolume v = readSeries(s);
    const Nifti truth = readNifti(niftis[n]);
    ASSERT_EQ(v.grid.size, Eigen::Vector3i(truth.dim[1], truth.dim[2], truth.dim[3]));
    int differ = 0;
    for (int k = 0; k < v.grid.size.z(); ++k)
      for (int j = 0; j < v.grid.size.y(); ++j)
        for (int i = 0; i < v.grid.size.x(); ++i)
          if (v.at(i, j, k) != truth.at(i, v.grid.size.y() - 1 - j, k)) ++differ;  // rows run the other way
    EXPECT_EQ(differ, 0) << n;
    for (const Eigen::Vector3d& index :
         {Eigen::Vector3d(0, 0, 0), Eigen::Vector3d(109, 0, 0), Eigen::Vector3d(0, 107, 0), Eigen::Vector3d(0, 0, 4),
          Eigen::Vector3d(109, 107, 4)}) {
      const Eigen::Vector4d p(index.x(), 107.0 - index.y(), index.z(), 1.0);
      const Eigen::Vector3d ras = truth.affine_ras * p;
      EXPECT_LT((v.grid.indexToLps(index) - Eigen::Vector3d(-ras.x(), -ras.y(), ras.z())).norm(), 1e-3) << index;
    }
  }
}

TEST(Mosaics, stepsOfTheAcquisitionAreNamed) {
  GLISSON_NEEDS_DATA("siemens_mre_phase");
  const ScanResult found = scan(test::sharedData() / "siemens_mre_phase" / "phase_046");
  ASSERT_EQ(found.series.size(), 24U);
  for (int n = 0; n < 24; ++n) {
    const Series& s = found.series[static_cast<std::size_t>(n)];
    EXPECT_EQ(s.encodingDirection, n / 8);
    EXPECT_EQ(s.temporalIndex, n % 8);
    EXPECT_NEAR(s.vibration_Hz.value_or(0.0), 20.0, 1e-9);
    EXPECT_EQ(s.role, SeriesRole::Phase) << s.roleReason;
    EXPECT_EQ(s.files.size(), 1U);
    EXPECT_EQ(s.uid, found.series[0].uid + (n == 0 ? "" : "#" + std::to_string(n + 1)));
  }
  EXPECT_THAT(found.series[9].warnings.back(), HasSubstr("encoding direction 2, time step 2"));
}

TEST(Mosaics, privateHeadersThatLieAreRefused) {
  const auto values = [](const std::string& bytes) {
    return csaValues(reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size());
  };
  const auto number = [](std::uint64_t n) { return test::DicomBytes::little(n, 4); };
  const auto entry = [&](std::string name, std::uint64_t items, std::uint64_t length, const std::string& data) {
    name.resize(64, '\0');
    return name + number(1) + std::string("IS\0\0", 4) + number(6) + number(items) + number(77) + number(length) +
           number(length) + number(77) + number(length) + data;
  };
  const std::string head = std::string("SV10\4\3\2\1", 8);
  const std::string good = head + number(1) + number(77) + entry("NumberOfImagesInMosaic", 1, 4, "5   ");
  EXPECT_THAT(values(good).at("NumberOfImagesInMosaic"), testing::ElementsAre("5"));
  for (std::size_t keep = 0; keep < good.size(); ++keep) EXPECT_THROW(values(good.substr(0, keep)), BadInput) << keep;
  EXPECT_THROW(values(head + number(1) + number(77) + entry("a", 1, 0xFFFFFFF0, "5   ")), BadInput);
  EXPECT_THROW(values(head + number(1) + number(77) + entry("a", 0x7FFFFFFF, 4, "5   ")), BadInput);
  EXPECT_THROW(values(head + number(0x7FFFFFFF) + number(77) + entry("a", 1, 4, "5   ")), BadInput);
}

TEST(Mosaics, withoutTheirPrivateHeaderTheyAreRefused) {
  EXPECT_THAT(saidOfImage([](test::DicomBytes& d) {
                d.first0008 = test::DicomBytes::element(0x00080008, "CS", "ORIGINAL\\PRIMARY\\P\\ND\\MOSAIC");
              }),
              testing::AllOf(HasSubstr("Siemens mosaic without its private header"), Not(HasSubstr("[read]"))));
}

TEST(Mosaics, commentsOfTheAcquisition) {
  const ElastographyStep step = elastographyStep("MRE: fI[0]dI[2]az[180]po[88]tI[7]VP[50000]TC[0;39940]");
  EXPECT_EQ(step.direction, 2);
  EXPECT_EQ(step.time, 7);
  EXPECT_EQ(step.frequency, 0);
  EXPECT_DOUBLE_EQ(step.vibration_Hz, 20.0);
  for (const char* odd : {"", "MRE:", "MRE: dI[", "MRE: dI[-1]tI[1e99]VP[nan]", "something dI[1]tI[1]"}) {
    EXPECT_EQ(elastographyStep(odd).direction, -1) << odd;
    EXPECT_EQ(elastographyStep(odd).time, -1) << odd;
    EXPECT_EQ(elastographyStep(odd).vibration_Hz, 0.0) << odd;
  }
}

}  // namespace
}  // namespace glisson::dicom
