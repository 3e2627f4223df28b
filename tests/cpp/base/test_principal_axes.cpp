#include "echopath/base/principal_axes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace echopath::test_principal_axes {
namespace {

constexpr double kRounding = 1e-15;  // of the largest entry: a few roundings; 8e-16 found

Eigen::Matrix2d symmetric(double a, double b, double c) {
  Eigen::Matrix2d m;
  m << a, b, b, c;
  return m;
}

TEST(PrincipalAxes, ValuesAreTheRootsOfTheCharacteristicPolynomialAndAxesSolveTheirEquation) {
  std::mt19937_64 generator(1);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  for (int i = 0; i < 1000; ++i) {
    const double unit = std::pow(10.0, 10.0 * uniform(generator));
    const double a = unit * uniform(generator), b = unit * uniform(generator), c = unit * uniform(generator);
    const PrincipalAxes found = principal_axes(symmetric(a, b, c));
    const double mean = 0.5 * (a + c), spread = std::hypot(0.5 * (a - c), b), rounding = kRounding * unit;
    EXPECT_NEAR(found.values[0], mean - spread, rounding);
    EXPECT_NEAR(found.values[1], mean + spread, rounding);
    EXPECT_LT((found.axes.transpose() * found.axes - Eigen::Matrix2d::Identity()).norm(), kRounding);
    EXPECT_LT((symmetric(a, b, c) * found.axes - found.axes * found.values.asDiagonal()).norm(), 2.0 * rounding);
  }
}

TEST(PrincipalAxes, OnlyTheLowerTriangleIsRead) {
  Eigen::Matrix2d lower = symmetric(2.0, 1.0, -1.0);
  lower(0, 1) = 100.0;
  EXPECT_EQ(principal_axes(lower).values, principal_axes(symmetric(2.0, 1.0, -1.0)).values);
}

TEST(PrincipalAxes, AscendWhereTheMatrixIsDiagonalOrNothing) {
  const PrincipalAxes turned = principal_axes(symmetric(3.0, 0.0, -2.0));
  EXPECT_EQ(turned.values, Eigen::Vector2d(-2.0, 3.0));
  EXPECT_EQ(turned.axes.cwiseAbs(), symmetric(0.0, 1.0, 0.0));
  EXPECT_EQ(principal_axes(Eigen::Matrix2d::Zero()).values, Eigen::Vector2d::Zero());
  EXPECT_EQ(principal_axes(Eigen::Matrix2d::Zero()).axes, Eigen::Matrix2d::Identity());
}

TEST(PrincipalAxes, TheRangeOfNumbersIsThatOfTheEntries) {
  for (const double unit : {1e-300, 1e300}) {
    const PrincipalAxes found = principal_axes(unit * symmetric(1.0, 1.0, 1.0));
    EXPECT_NEAR(found.values[0] / unit, 0.0, kRounding);
    EXPECT_NEAR(found.values[1] / unit, 2.0, 2 * kRounding);
  }
}

}  // namespace
}  // namespace echopath::test_principal_axes
