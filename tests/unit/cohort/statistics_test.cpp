// SPDX-License-Identifier: GPL-3.0-or-later
#include "cohort/statistics.h"

#include <gtest/gtest.h>

#include <cmath>

#include "cohort/detail/summary.h"

namespace glisson::cohort {
namespace {

CaseRecord done(const std::string& id, double shear_kPa, double mean_mm, double at_retractor_mm) {
  CaseRecord r = recordOf(id, "key", "", "");
  r.outcome.status = CaseOutcome::Status::Done;
  r.shear_kPa = shear_kPa;
  r.youngs_kPa = 3.0 * shear_kPa;
  r.mean_mm = mean_mm;
  r.at_retractor_mm = at_retractor_mm;
  return r;
}

TEST(CohortStatistics, SpreadOfKnownNumbers) {
  const Spread s = spreadOf({2.0, 4.0, 4.0, 4.0, 5.0, 5.0, 7.0, 9.0, std::nan("")});
  EXPECT_EQ(s.n, 8u);
  EXPECT_DOUBLE_EQ(s.mean, 5.0);
  EXPECT_DOUBLE_EQ(s.sd, std::sqrt(32.0 / 7.0));
  EXPECT_DOUBLE_EQ(s.median, 4.5);
  EXPECT_TRUE(std::isnan(spreadOf({}).mean));
}

TEST(CohortStatistics, FractionsAgainstTheAtlasLikeWithLikeAndAsPublished) {
  std::vector<CaseRecord> records;
  for (const double mu : {1.0, 2.0, 2.1, 3.0, 3.2, 4.0, 4.3, 5.0, 2.2, 1.9})
    records.push_back(done("case", mu, 1.0, 1.0));
  const StiffnessStudy like = stiffnessStudy(records, false);
  EXPECT_DOUBLE_EQ(like.fractionOver1kPa, 0.4);   // 3.2, 4.0, 4.3, 5.0 above 3.1
  EXPECT_DOUBLE_EQ(like.fractionOverTwice, 0.2);  // 4.3, 5.0 above 4.2
  const StiffnessStudy published = stiffnessStudy(records, true);
  EXPECT_DOUBLE_EQ(published.fractionOver1kPa, 0.9);  // all of 3 µ but 3.0 above 3.1
  EXPECT_DOUBLE_EQ(published.spread.max, 15.0);
}

TEST(CohortStatistics, PatientsWhoseMeasurementFailedDoNotCount) {
  std::vector<CaseRecord> records = {done("case-001", 2.0, 1.0, 6.0), recordOf("case-002", "", "", "")};
  records[1].outcome.status = CaseOutcome::Status::Rejected;
  EXPECT_EQ(stiffnessStudy(records, false).values_kPa.size(), 1u);
  const RetractionStudy s = retractionStudy(records);
  EXPECT_EQ(s.tried, 2u);
  EXPECT_EQ(s.rejected, 1u);
  EXPECT_EQ(s.left, 1u);
  EXPECT_DOUBLE_EQ(s.fractionSignificant, 1.0);
  EXPECT_DOUBLE_EQ(s.fractionWithinVoxel, 1.0);
}

TEST(CohortStatistics, SharesHaveTheIntervalOfTheirProbabilities) {
  EXPECT_FALSE(sureShareOf({}));
  EXPECT_FALSE(sureShareOf({std::nan("")}));
  // Certain patients leave nothing open.
  const SureShare certain = sureShareOf({1.0, 0.0, 1.0, 1.0}).value();
  EXPECT_DOUBLE_EQ(certain.expected, 0.75);
  EXPECT_EQ(certain.low, 0.75);
  EXPECT_EQ(certain.high, 0.75);
  // Equal probabilities: binomial, of 20 at .3 from 2 to 10 (P(k <= 1) = .0076, P(k <= 2) = .0355, P(k <= 9) = .952,
  // P(k <= 10) = .983).
  const SureShare binomial = sureShareOf(std::vector<double>(20, 0.3)).value();
  EXPECT_EQ(binomial.n, 20u);
  EXPECT_NEAR(binomial.expected, 0.3, 1e-12);
  EXPECT_DOUBLE_EQ(binomial.low, 2.0 / 20);
  EXPECT_DOUBLE_EQ(binomial.high, 10.0 / 20);
}

TEST(CohortStatistics, SharesOfTheStudyComeFromPatientsThatSayHowSureTheyAre) {
  std::vector<CaseRecord> records = {done("a", 2, 1, 6), done("b", 2, 1, 4), done("c", 2, 1, 1), done("d", 2, 1, 9)};
  EXPECT_FALSE(retractionStudy(records).sureSignificant);
  const auto run = [](const std::string& id, double p) {
    CaseRecord r = recordOf(id, "key", "",
                            R"({"difference": {"mean_mm": 1, "at_retractor_mm": 4, "probability_beyond_5mm": )" +
                                std::to_string(p) +
                                R"(, "probability_mean_within_voxel": 1, "interval95": {"at_retractor_mm": [2, 7]}}})");
    r.outcome.status = CaseOutcome::Status::Done;
    return r;
  };
  records[0] = run("a", 0.5);
  records[1] = run("b", 0.5);
  EXPECT_EQ(records[0].at_retractor_low_mm, 2.0);
  EXPECT_EQ(records[0].at_retractor_high_mm, 7.0);
  const RetractionStudy s = retractionStudy(records);
  ASSERT_TRUE(s.sureSignificant && s.sureWithinVoxel);
  EXPECT_EQ(s.sureSignificant->n, 2u);
  EXPECT_DOUBLE_EQ(s.sureSignificant->expected, 0.5);
  EXPECT_EQ(s.sureSignificant->low, 0.0);
  EXPECT_EQ(s.sureSignificant->high, 1.0);
  EXPECT_EQ(s.sureWithinVoxel->low, 1.0);
  EXPECT_FALSE(s.sureTravelSignificant);
  const CaseRecord back = parseRecord(toJson(records[0])).value();
  EXPECT_EQ(back.probability_beyond_5mm, 0.5);
  EXPECT_EQ(back.at_retractor_high_mm, 7.0);
}

TEST(CohortStatistics, ChoosesFourDifferentPatientsByTheData) {
  std::vector<CaseRecord> records;
  const std::vector<double> at = {1.0, 2.0, 2.0, 3.0, 3.0, 3.1, 4.0, 4.0, 5.0, 12.0};
  for (std::size_t i = 0; i < at.size(); ++i) records.push_back(done("case-" + std::to_string(i), 2.0, 1.0, at[i]));
  const std::vector<Chosen> c = chooseCases(records);
  ASSERT_EQ(c.size(), 4u);
  const Spread s = spreadOf(at);  // 3.91 ± 3.07
  EXPECT_EQ(c[0].what, "mean");
  EXPECT_NEAR(c[0].at_retractor_mm, s.mean, 0.1);
  EXPECT_EQ(c[1].what, "+1 SD");
  EXPECT_EQ(c[1].at_retractor_mm, 5.0);
  EXPECT_EQ(c[3].what, "outlier");
  EXPECT_EQ(c[3].at_retractor_mm, 12.0);
  for (std::size_t i = 0; i < 4; ++i)
    for (std::size_t k = 0; k < i; ++k) EXPECT_NE(c[i].id, c[k].id);
  // Who cannot be drawn is passed over, and counted; where nobody can be, the data alone decide.
  records[9].drawable = false;
  const std::vector<Chosen> drawn = chooseCases(records);
  ASSERT_EQ(drawn.size(), 4u);
  EXPECT_EQ(drawn[3].at_retractor_mm, 5.0);
  EXPECT_EQ(drawn[3].passedOver, 1u);
  for (const Chosen& d : drawn) EXPECT_NE(d.id, "case-9");
  for (CaseRecord& r : records) r.drawable = false;
  EXPECT_EQ(chooseCases(records)[3].at_retractor_mm, 12.0);
  records.resize(1);
  EXPECT_EQ(chooseCases(records).size(), 1u);
  EXPECT_TRUE(chooseCases({}).empty());
}

TEST(CohortRecords, SurviveWritingAndReading) {
  CaseRecord r = done("case-007", 0.1 + 0.2, 1.0 / 3.0, 5.0);
  r.warnings = {"a \"quoted\" warning"};
  const std::string text = toJson(r);
  const auto back = parseRecord(text);
  ASSERT_TRUE(back);
  EXPECT_EQ(toJson(*back), text);
  EXPECT_EQ(back->shear_kPa, r.shear_kPa);
  EXPECT_TRUE(std::isnan(back->vessel_mean_mm));
  EXPECT_FALSE(parseRecord(text.substr(0, text.size() / 2)));
  EXPECT_FALSE(parseRecord("{\"schema\": \"something else\"}"));
}

TEST(CohortRecords, TakeTheNumbersOfTheVerbs) {
  const CaseRecord r = recordOf(
      "case-001", "k", R"({"quantity":"youngs","pooled":{"n":7,"mean_kPa":6.0,"sd_kPa":0.6},"youngs_mean_kPa":6.0,
      "warnings":["w"]})",
      R"({"difference":{"mean_mm":1.5,"at_retractor_mm":5.5},"model":{"dofs":9,"volume_mL":2.5},"linear_valid":true,
      "discretisation_error":{"max_mm":3.0,"difference":{"mean_mm":0.1,"at_retractor_mm":0.25}},"warnings":["w","v"]})");
  EXPECT_DOUBLE_EQ(r.shear_kPa, 2.0);
  EXPECT_DOUBLE_EQ(r.sd_kPa, 0.2);
  EXPECT_EQ(r.voxels, 7);
  EXPECT_DOUBLE_EQ(r.at_retractor_mm, 5.5);
  EXPECT_DOUBLE_EQ(r.discretisation_mm, 3.0);
  EXPECT_DOUBLE_EQ(r.difference_error_mm, 0.25);
  EXPECT_EQ(r.dofs, 9);
  EXPECT_TRUE(r.linear_valid);
  EXPECT_EQ(r.warnings, (std::vector<std::string>{"w", "v"}));
}

TEST(CohortRecords, NameNobody) {
  EXPECT_EQ(
      detail::anonymous("glisson-cli: /data/Doe^Jane/mri/x.dcm of Doe^Jane is cut off", "/data/Doe^Jane", "case-002"),
      "mri/x.dcm of case-002 is cut off");
  EXPECT_EQ(
      detail::anonymous("series 3 cannot be read as a volume: a slice is missing at 12 mm (between 'DOE_0178.dcm' "
                        "and 'DOE_0180.dcm'); it has no 'stiffness', the region's name is 'Doe's liver'",
                        "/data/7", "case-007"),
      "series 3 cannot be read as a volume: a slice is missing at 12 mm (between (a name) and (a name)); it has no "
      "'stiffness', the region's name is (a name)");
  EXPECT_EQ(detail::anonymous("nothing in '/data/2/': 2 of IM-0002.dcm, 20 slices", "/data/2", "case-002"),
            "nothing in 'case-002': case-002 of IM-0002.dcm, 20 slices");
}

}  // namespace
}  // namespace glisson::cohort
