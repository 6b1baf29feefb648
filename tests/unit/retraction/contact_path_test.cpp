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

TEST(ContactPath, TheCapacityHasATravelOfItsOwn) {
  RigidContact c;
  c.path = {{0, 0}, {4, 2}, {10, 8}, {12, 6}, {20, 3}};
  c.travel_mm = 20;
  c.capacity_N = 8;
  EXPECT_EQ(travelAtCapacity(c), 10) << "not where the bar ended";
  c.capacity_N = 5;  // the answer's cells bear less than the path's
  EXPECT_EQ(travelAtCapacity(c), 7);
  c.capacity_N = 9;  // or more
  EXPECT_EQ(travelAtCapacity(c), 10);
  c.path.clear();
  EXPECT_EQ(travelAtCapacity(c), 20);
}

TEST(Offered, SaysWhatRefusesAndWhatToDo) {
  retraction::Setup s;
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
