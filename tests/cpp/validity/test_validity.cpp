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

TEST(Validity, CallsSharesFarBelowAnyNoiseNothing) {
  Validity report;
  report.shares.blocked = 7e-115;
  report.shares.left = 2.3e-5;
  EXPECT_NE(report.text().find("something comes in the way        0 %"), std::string::npos);
  EXPECT_NE(report.text().find("reflection leaves its surface     0.0023 %"), std::string::npos);
}

}  // namespace
}  // namespace echopath::test_validity
