// What the report of a frame advises.
#include <gtest/gtest.h>

#include <limits>

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

}  // namespace
}  // namespace echopath::test_validity
