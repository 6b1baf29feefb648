// SPDX-License-Identifier: GPL-3.0-or-later
#include <numeric>

#include "dicom/thumbnail.h"
#include "said.h"

namespace glisson::dicom {
namespace {

using test::DicomBytes;
using test::TemporaryFolder;
using testing::HasSubstr;

/// The only series of an image by this maker, with this image type and description.
Series imageOf(const std::string& maker, const std::string& type, const std::string& description,
               const std::string& rescaleType = {}) {
  const TemporaryFolder folder;
  DicomBytes d;
  d.first0008 = DicomBytes::element(0x00080008, "CS", type);
  d.extra0008 = DicomBytes::element(0x00080070, "LO", maker) + DicomBytes::element(0x0008103E, "LO", description);
  if (!rescaleType.empty())
    d.rescale = DicomBytes::element(0x00281052, "DS", "0") + DicomBytes::element(0x00281053, "DS", "0.01") +
                DicomBytes::element(0x00281054, "LO", rescaleType);
  return scan(d.write(folder / "image")).series.at(0);
}

TEST(Vendors, siemensProductsByDescriptionAndImageType) {
  const auto role = [](const std::string& type, const std::string& description) {
    return imageOf("SIEMENS", type, description).role;
  };
  EXPECT_EQ(role("DERIVED\\SECONDARY\\OTHER", "greMRE_60Hz_Stiffness"), SeriesRole::Stiffness);
  EXPECT_EQ(role("DERIVED\\SECONDARY\\STIFFNESS", "mre_60Hz"), SeriesRole::Stiffness);
  EXPECT_EQ(role("DERIVED\\SECONDARY\\OTHER", "greMRE_60Hz_ConfMap"), SeriesRole::Confidence);
  EXPECT_EQ(role("DERIVED\\SECONDARY\\WAVE", "greMRE_60Hz_Wave"), SeriesRole::Wave);
  EXPECT_EQ(role("ORIGINAL\\PRIMARY\\P\\ND", "greMRE_60Hz"), SeriesRole::Phase);
  EXPECT_EQ(role("ORIGINAL\\PRIMARY\\M\\ND", "greMRE_60Hz"), SeriesRole::Magnitude);
  EXPECT_EQ(role("ORIGINAL\\PRIMARY\\M\\ND", "t1_vibe_fs_tra"), SeriesRole::Anatomical);
}

TEST(Vendors, philipsProductsByImageType) {
  const auto role = [](const std::string& type, const std::string& description) {
    return imageOf("Philips Medical Systems", type, description).role;
  };
  EXPECT_EQ(role("DERIVED\\PRIMARY\\STIFFNESS\\STIFFNESS", "MRE liver"), SeriesRole::Stiffness);
  EXPECT_EQ(role("DERIVED\\PRIMARY\\WAVE\\MRE", "MRE liver"), SeriesRole::Wave);
  EXPECT_EQ(role("DERIVED\\PRIMARY\\CONFIDENCE\\MRE", "MRE liver"), SeriesRole::Confidence);
  EXPECT_EQ(role("ORIGINAL\\PRIMARY\\PHASE MAP\\P\\FFE", "MRE liver"), SeriesRole::Phase);
  EXPECT_EQ(role("ORIGINAL\\PRIMARY\\M_FFE\\M\\FFE", "MRE liver"), SeriesRole::Magnitude);
  EXPECT_EQ(role("ORIGINAL\\PRIMARY\\M_FFE\\M\\FFE", "mDIXON"), SeriesRole::Anatomical);
}

TEST(Vendors, theUnitIsWhatTheFileSaysAndNeverAGuess) {
  EXPECT_FALSE(imageOf("SIEMENS", "DERIVED\\STIFFNESS", "mre").unit);
  EXPECT_EQ(imageOf("SIEMENS", "DERIVED\\STIFFNESS", "mre (kPa)").unit.value_or(""), "kPa");
  EXPECT_EQ(imageOf("SIEMENS", "DERIVED\\STIFFNESS", "mre [Pa]").unit.value_or(""), "Pa");
  EXPECT_EQ(imageOf("Philips", "DERIVED\\STIFFNESS", "mre", "kPa").unit.value_or(""), "kPa");
  EXPECT_FALSE(imageOf("Philips", "DERIVED\\STIFFNESS", "mre", "US").unit);
}

TEST(Vendors, rolesSetByHandCountMore) {
  ScanResult found;
  for (int n = 1; n <= 3; ++n) {
    Series s;
    s.uid = "1.2." + std::to_string(n);
    s.number = 100 + n;
    s.role = n == 1 ? SeriesRole::Stiffness : SeriesRole::Other;
    s.grid.size.z() = 10;
    found.series.push_back(s);
  }
  found.series[2].uid = "1.2.2#2";
  EXPECT_EQ(findRole(found, SeriesRole::Stiffness).number, 101);
  EXPECT_TRUE(applyRoles(found, {{"1.2.2#2", SeriesRole::Stiffness}}).empty());
  EXPECT_EQ(findRole(found, SeriesRole::Stiffness).number, 103);
  EXPECT_EQ(found.series[1].role, SeriesRole::Other);
  EXPECT_TRUE(applyRoles(found, {{"1.2.2", SeriesRole::Wave}}).empty());  // every volume of that series
  EXPECT_EQ(found.series[1].role, SeriesRole::Wave);
  EXPECT_EQ(found.series[2].role, SeriesRole::Wave);
  EXPECT_EQ(found.series[2].roleReason, "set by hand");
  EXPECT_THAT(applyRoles(found, {{"102", SeriesRole::Confidence}, {"9", SeriesRole::Wave}}), testing::ElementsAre("9"));
  EXPECT_EQ(found.series[1].role, SeriesRole::Confidence);
  for (const char* word :
       {"anatomical", "magnitude", "wave", "stiffness", "confidence", "colour-copy", "other", "phase"})
    EXPECT_EQ(name(roleNamed(word)), word);
  EXPECT_THROW(roleNamed("stiff"), BadInput);
}

TEST(Thumbnails, middleSliceKeepsItsShapeAndWindow) {
  const TemporaryFolder folder;
  for (int k = 0; k < 3; ++k) {
    DicomBytes d;
    d.sopUid += std::to_string(k);
    d.position = "0\\0\\" + std::to_string(5 * k);
    d.rows = 40;
    d.columns = 60;
    d.spacing = "2\\1";  // 80 mm high, 60 mm wide
    d.pixels.clear();
    for (unsigned row = 0; row < 40; ++row)
      for (unsigned column = 0; column < 60; ++column) d.pixels += DicomBytes::little(k == 1 ? row * 100 : 7, 2);
    d.write(folder / std::to_string(k));
  }
  const Series s = scan(folder.path()).series.at(0);
  const Thumbnail t = thumbnail(s, 32);
  EXPECT_EQ(t.height, 32);
  EXPECT_EQ(t.width, 24);
  ASSERT_EQ(t.grey.size(), 32U * 24U);
  EXPECT_EQ(t.grey.front(), 0);
  EXPECT_EQ(t.grey.back(), 255);
  for (std::size_t n = 24; n < t.grey.size(); ++n) EXPECT_GE(t.grey[n], t.grey[n - 24]);
  Series burned = s;
  burned.burnedIn = true;
  EXPECT_EQ(thumbnail(burned).width, 0);
  EXPECT_THAT(thumbnail(burned).whyNone, HasSubstr("text about the patient"));
  Series broken = s;
  broken.error = "its slices are odd";
  EXPECT_THAT(thumbnail(broken).whyNone, HasSubstr("its slices are odd"));
}

TEST(Thumbnails, picturesOfScreensAreTakenForBurnedInUnlessTheyDenyIt) {
  const TemporaryFolder folder;
  const auto burned = [&folder](const std::string& sopClass, const std::string& said) {
    DicomBytes d;
    std::string image = d.bytes();
    const std::string usual = DicomBytes::element(0x00080016, "UI", "1.2.840.10008.5.1.4.1.1.4");
    image.replace(image.find(usual), usual.size(), DicomBytes::element(0x00080016, "UI", sopClass));
    if (!said.empty())
      image.insert(image.find(DicomBytes::tag(0x00280010)), DicomBytes::element(0x00280301, "CS", said));
    return scan(DicomBytes::write(folder / "image", image)).series.at(0).burnedIn;
  };
  const std::string mr = "1.2.840.10008.5.1.4.1.1.4";
  const std::string screen = "1.2.840.10008.5.1.4.1.1.7";
  EXPECT_FALSE(burned(mr, ""));
  EXPECT_TRUE(burned(mr, "YES"));
  EXPECT_TRUE(burned(screen, ""));
  EXPECT_FALSE(burned(screen, "NO"));
}

}  // namespace
}  // namespace glisson::dicom
