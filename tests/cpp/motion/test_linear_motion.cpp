#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "echopath/base/constants.h"
#include "echopath/motion/motion.h"

namespace echopath::test_linear_motion {
namespace {

constexpr double kRounding = 1e-14;  // a few units in the last place of numbers near 1

TEST(LinearMotion, TurnsRightHandedAboutItsAxis) {
  const LinearMotion motion(Vec3(1, 2, 3), Vec3(0, 0, kPi / 2));  // a quarter turn each second
  const Vec3 after_one_second = motion.at(1.0) * Vec3(1, 0, 0);
  EXPECT_LT((after_one_second - Vec3(1, 3, 3)).norm(), kRounding);
  const Vec3 about_y = LinearMotion(Vec3::Zero(), Vec3(0, kPi / 2, 0)).at(1.0) * Vec3(1, 0, 0);
  EXPECT_LT((about_y - Vec3(0, 0, -1)).norm(), kRounding);
}

TEST(LinearMotion, FollowsTheRotationFormulaOfRodrigues) {
  const Vec3 rate(0.3, -1.2, 0.7), point(2, -1, 0.5);
  const double time = 1.7, angle = rate.norm() * time;
  const Vec3 axis = rate / rate.norm();
  const Vec3 expected =
      point * std::cos(angle) + axis.cross(point) * std::sin(angle) + axis * axis.dot(point) * (1.0 - std::cos(angle));
  EXPECT_LT((LinearMotion(Vec3::Zero(), rate).at(time) * point - expected).norm(), kRounding);
}

TEST(LinearMotion, IsAtHomeAtTimeZeroAndDefinedAlways) {
  const LinearMotion motion(Vec3(5, 0, 0), Vec3(1, 0, 0));
  EXPECT_EQ(motion.at(0.0).matrix(), Transform::Identity().matrix());
  EXPECT_EQ(motion.at(-2.0).translation().x(), -10.0);
  EXPECT_TRUE(motion.breakpoints().empty());
  EXPECT_LE(motion.span().begin, -1e300);
  EXPECT_GE(motion.span().end, 1e300);
}

TEST(LinearMotion, RefusesWhatIsNotFinite) {
  const double nan = std::numeric_limits<double>::quiet_NaN(), infinity = std::numeric_limits<double>::infinity();
  EXPECT_THROW(LinearMotion(Vec3(nan, 0, 0)), std::invalid_argument);
  EXPECT_THROW(LinearMotion(Vec3::Zero(), Vec3(0, infinity, 0)), std::invalid_argument);
  EXPECT_THROW(LinearMotion(Vec3::Zero()).at(nan), std::invalid_argument);
}

}  // namespace
}  // namespace echopath::test_linear_motion
