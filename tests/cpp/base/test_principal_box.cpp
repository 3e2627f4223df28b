#include <gtest/gtest.h>

#include "echopath/base/principal_box.h"

namespace echopath::test_principal_box {
namespace {

constexpr double kRounding = 1e-13;  // m

TEST(PrincipalBox, CornersOfATurnedBoxGiveItsSides) {
  const Eigen::AlignedBox3d box(Vec3(-1.0, -2.0, -4.5), Vec3(1.0, 2.0, 4.5));
  const Mat3 turn = Eigen::AngleAxisd(0.7, Vec3(1.0, -2.0, 0.5).normalized()).toRotationMatrix();
  const Vec3 place(30.0, -7.0, 2.0);
  std::vector<Vec3> corners;
  for (int i = 0; i < 8; ++i) corners.push_back(place + turn * box.corner(Eigen::AlignedBox3d::CornerType(i)));
  const PrincipalBox found = principal_box(corners);
  EXPECT_LT((found.mean - place).norm(), kRounding);
  EXPECT_LT((found.box.sizes() - Vec3(2.0, 4.0, 9.0)).norm(), kRounding);
  EXPECT_NEAR(std::abs(found.axes.col(2).dot(turn.col(2))), 1.0, kRounding);
  EXPECT_LT(found.coordinates(place).norm(), kRounding);
}

}  // namespace
}  // namespace echopath::test_principal_box
