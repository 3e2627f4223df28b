// What the report of a frame advises.
#include <gtest/gtest.h>

#include <limits>
#include <string>

#include "echopath/validity/validity.h"

namespace echopath::test_validity {
namespace {

TEST(Validity, AdvisesAWholeNumberOfKeyframesHoweverFastThingsMove) {
  Validity report;
  EXPECT_EQ(report.keyframes(), 1);
  for (const double error : {1e30, 1e300, std::numeric_limits<double>::infinity()}) {
    report.motion_phase_error = error;  // rad
    EXPECT_EQ(report.keyframes(), kMaxKeyframes) << error;
  }
}

ObjectValidity heard_object() {
  ObjectValidity object;
  object.name = "blade";
  object.has_paths = object.is_in_range = true;
  return object;
}

// Whatever an object lacks, the advice to trace parts of the frame names more than one.
TEST(Validity, AdvisesSeveralKeyframesForObjectsAlone) {
  Validity report;
  report.objects = {heard_object()};
  EXPECT_EQ(report.keyframes(), 1);
  EXPECT_TRUE(report.warnings().empty());
  for (double ObjectValidity::* lack :
       {&ObjectValidity::error_db, static_cast<double ObjectValidity::*>(&ObjectValidity::left),
        static_cast<double ObjectValidity::*>(&ObjectValidity::turned),
        static_cast<double ObjectValidity::*>(&ObjectValidity::blocked),
        static_cast<double ObjectValidity::*>(&ObjectValidity::new_surface)}) {
    for (const double size : {-0.6, 0.6}) {
      if (size < 0 && lack != &ObjectValidity::error_db) continue;
      report.objects = {heard_object()};
      report.objects.front().*lack = size;
      EXPECT_EQ(report.keyframes(), kOcclusionKeyframes);
      report.objects.front().turn = 6.4;  // rad: a full turn
      EXPECT_EQ(report.keyframes(), 32);
      ASSERT_EQ(report.warnings().size(), 1u);
      EXPECT_NE(report.warnings().front().find("Trace each of 32 parts"), std::string::npos);
    }
  }
  report.objects = {heard_object()};
  report.objects.front().has_paths = false;
  EXPECT_EQ(report.keyframes(), kOcclusionKeyframes);
  report.objects = {heard_object()};
  report.objects.front().beside_edges = 0.06;
  EXPECT_EQ(report.keyframes(), 2);
}

// Another time has the same echoes: what antennas at the rim of an array lack is no matter of keyframes.
TEST(Validity, AdvisesNoKeyframesForWhatStandsStill) {
  Validity report;
  report.shares.blocked = report.shares.turned = 0.5;
  EXPECT_EQ(report.keyframes(), kOcclusionKeyframes);
  report.is_still = report.has_array = true;
  EXPECT_EQ(report.keyframes(), 1);
}

TEST(Validity, CallsSharesFarBelowAnyNoiseNothing) {
  Validity report;
  report.shares.blocked = 7e-115;
  report.shares.left = 2.3e-5;
  EXPECT_NE(report.text().find("something comes in the way        0 %"), std::string::npos);
  EXPECT_NE(report.text().find("reflection leaves its surface     0.0023 %"), std::string::npos);
}

}  // namespace
}  // namespace echopath::test_validity
