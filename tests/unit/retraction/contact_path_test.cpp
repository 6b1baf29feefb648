// SPDX-License-Identifier: GPL-3.0-or-later

// What is read from the way of a bar, and what a scene offers.
#include "retraction/contact_path.h"

#include <gtest/gtest.h>

#include "retraction/offered.h"

namespace glisson::retraction {
namespace {

TEST(ContactPath, ForcesLieOnTheWay) {
  const ContactPath path = {{0, 0}, {4, 2}, {10, 8}, {12, 6}};
  EXPECT_EQ(forceAt(path, -1), 0);
  EXPECT_EQ(forceAt(path, 4), 2);
  EXPECT_EQ(forceAt(path, 7), 5);
  EXPECT_EQ(forceAt(path, 11), 7);
  EXPECT_EQ(forceAt(path, 20), 6);
  EXPECT_EQ(forceAt({}, 3), 0);
}

TEST(ContactPath, ItIsBroughtToTheAnswer) {
  RigidContact c;
  c.path = {{0, 0}, {4, 2}, {10, 8}, {12, 9}};
  c.hoist = {0, -1, 0};
  c.force_N = {0.5, -5, 0};
  c.travel_mm = 14;  // coarse cells bear 5 N at 7 mm: half of that
  EXPECT_DOUBLE_EQ(answersForceAt(c, 14), 5);
  EXPECT_DOUBLE_EQ(answersForceAt(c, 8), 2);
  EXPECT_DOUBLE_EQ(answersForceAt(c, 11), 3.5);
  c.force_N = {0, -20, 0};  // more than the path bears: as it is
  EXPECT_EQ(answersForceAt(c, 4), 2);
}

TEST(ContactPath, ABarThatPassedALargerForceIsToldWhere) {
  RigidContact c;
  c.asked_mm = 20;
  c.path = {{0, 0}, {4, 2}, {10, 8}, {12, 6}, {20, 3}};
  ASSERT_TRUE(passedOnTheWay(c));
  EXPECT_EQ((*passedOnTheWay(c))[0], 10);
  EXPECT_EQ((*passedOnTheWay(c))[1], 8);
  c.path.back()[1] = 7.5;
  EXPECT_FALSE(passedOnTheWay(c));
}

TEST(ContactPath, ABarThatGaveWayOnItsWayIsToldWhere) {
  RigidContact c;
  c.path = {{0, 0}, {4, 2}, {10, 8}, {12, 7}, {14, 9}, {18, 5}, {20, 9.5}, {24, 9.4}, {28, 12}};
  ASSERT_TRUE(gaveWayOnTheWay(c));
  EXPECT_EQ((*gaveWayOnTheWay(c))[0], 14) << "the deepest of three falls";
  EXPECT_EQ((*gaveWayOnTheWay(c))[1], 9);
  c.path = {{0, 0}, {4, 2}, {10, 8}, {12, 7.7}, {14, 9}};
  EXPECT_FALSE(gaveWayOnTheWay(c)) << "within what states of the path are off by";
  c.path = {{0, 0}, {10, 8}, {20, 3}};
  EXPECT_FALSE(gaveWayOnTheWay(c)) << "it did not rise again: passedOnTheWay";
  EXPECT_FALSE(gaveWayOnTheWay(RigidContact{}));
}

TEST(Offered, SaysWhatRefusesAndWhatToDo) {
  glisson::retraction::Setup s;
  Retractor bar;
  bar.contact.reset();
  s.loads = {bar};
  EXPECT_FALSE(patchTakenFor(s));
  EXPECT_EQ(wayToLargeDeformation(s), "choose \"kinematics\": \"hyperelastic\"");
  s.kinematics = Kinematics::Corotational;
  EXPECT_EQ(patchTakenFor(s), RigidRefusal::Corotational);
  EXPECT_FALSE(largeDeformationRefusal(s)) << "they are large deformation";
  s.kinematics = Kinematics::Linear;
  s.model.kind = ModelKind::FemTet;
  EXPECT_EQ(patchTakenFor(s), RigidRefusal::Model);
  EXPECT_EQ(nameOf(RigidRefusal::Model), "model");
  EXPECT_NE(wayToLargeDeformation(s).find("take the model \"fem-hex\""), std::string::npos);
  std::get<Retractor>(s.loads[0]).contact = ContactKind::Patch;
  EXPECT_FALSE(patchTakenFor(s)) << "asked for";
}

}  // namespace
}  // namespace glisson::retraction
