#include <gtest/gtest.h>

#include <cmath>

#include "cpp/support/expect_error.h"
#include "echopath/motion/deformation.h"
#include "echopath/motion/skin.h"

namespace echopath::test_skin {
namespace {

using test::expect_error;
using Invalid = std::invalid_argument;

constexpr double kRounding = 1e-14;                       // of a few operations on numbers of order 1
constexpr double kShoulderRate = 1.3, kElbowRate = -2.1;  // rad/s

Transform at_position(const Vec3& position) {
  Transform transform = Transform::Identity();
  transform.translation() = position;
  return transform;
}

std::shared_ptr<const Motion> turning(double rate) {
  return std::make_shared<const LinearMotion>(Vec3::Zero(), Vec3(0, 0, rate));
}

// Shoulder at (1, 2, 0), elbow 0.5 m along x from it, both turning about z.
std::vector<Joint> two_links() {
  Joint shoulder{"shoulder", -1, at_position({1, 2, 0}), turning(kShoulderRate), {}};
  Joint elbow{"elbow", 0, at_position({0.5, 0, 0}), turning(kElbowRate), {}};
  return {shoulder, elbow};
}

SkinWeights rows(int64_t per_vertex, std::vector<uint32_t> joint, std::vector<double> weight) {
  return {per_vertex, std::move(joint), std::move(weight)};
}

Vec3 turned(const Vec3& v, double angle) {
  return {v.x() * std::cos(angle) - v.y() * std::sin(angle), v.x() * std::sin(angle) + v.y() * std::cos(angle), v.z()};
}

Vec3 on_upper_arm(const Vec3& v, double time) { return Vec3(1, 2, 0) + turned(v - Vec3(1, 2, 0), kShoulderRate * time); }

Vec3 on_forearm(const Vec3& v, double time) {
  const Vec3 elbow = on_upper_arm({1.5, 2, 0}, time);
  return elbow + turned(v - Vec3(1.5, 2, 0), (kShoulderRate + kElbowRate) * time);
}

const std::vector<Vec3> kVertices = {{1.2, 2.1, 0.3}, {1.5, 2.1, 0}, {1.9, 2.0, -0.2}};

Skin arm() { return Skin(kVertices, two_links(), rows(2, {0, 1, 0, 1, 1, 0}, {1, 0, 0.25, 0.75, 1, 0})); }

TEST(Skin, AtRestVerticesStandAsBound) {
  const std::vector<Vec3> vertices = arm().at(0.0);
  for (size_t i = 0; i < kVertices.size(); ++i) EXPECT_LT((vertices[i] - kVertices[i]).norm(), kRounding);
}

TEST(Skin, VerticesOfOneJointMoveRigidly) {
  for (const double time : {0.0, 0.4, 2.5}) {
    const std::vector<Vec3> vertices = arm().at(time);
    EXPECT_LT((vertices[0] - on_upper_arm(kVertices[0], time)).norm(), kRounding);
    EXPECT_LT((vertices[2] - on_forearm(kVertices[2], time)).norm(), kRounding);
  }
}

TEST(Skin, VerticesBetweenJointsLieBetweenWhereEachWouldTakeThem) {
  const Vec3 expected = 0.25 * on_upper_arm(kVertices[1], 0.7) + 0.75 * on_forearm(kVertices[1], 0.7);
  EXPECT_LT((arm().at(0.7)[1] - expected).norm(), kRounding);
}

TEST(Skin, GivenBindMatricesReplaceTheRestPose) {
  std::vector<Joint> joints = two_links();
  joints[0].inverse_bind = at_position({-3, 0, 0});
  const Skin skin({{3.1, 0, 0}}, joints, rows(1, {0}, {1.0}));
  EXPECT_LT((skin.at(0.0)[0] - Vec3(1.1, 2, 0)).norm(), kRounding);
  EXPECT_EQ(skin.joints()[0].inverse_bind->translation(), Vec3(-3, 0, 0));
}

TEST(Skin, AFewVerticesAreTheSameAsThoseOfAll) {
  const std::vector<uint32_t> indices = {2, 0, 0, 1};
  std::vector<Vec3> some(9);
  arm().at(0.37, indices, some);
  const std::vector<Vec3> all = arm().at(0.37);
  ASSERT_EQ(some.size(), indices.size());
  for (size_t i = 0; i < indices.size(); ++i) EXPECT_EQ(some[i], all[indices[i]]);
}

TEST(Skin, BreakpointsAreThoseOfAllJointsAndTheSpanIsCommon) {
  std::vector<Joint> joints = two_links();
  const std::vector<Vec3> still(4, Vec3::Zero());
  const auto keys = [&](std::vector<double> times) {
    return std::make_shared<const KeyframeMotion>(times, still, std::vector<Quaternion>{}, Interpolation::kLinear);
  };
  joints[0].motion = keys({0, 1, 2, 5});
  joints[1].motion = keys({-1, 1, 3, 4});
  joints.push_back({"cap", 0, Transform::Identity(), nullptr, {}});
  const Skin skin(kVertices, joints, rows(1, {0, 0, 1}, {1, 1, 1}));
  EXPECT_EQ(skin.breakpoints(), (std::vector<double>{1, 2, 3}));
  EXPECT_EQ(skin.span().begin, 0.0);
  EXPECT_EQ(skin.span().end, 4.0);
  EXPECT_TRUE(arm().breakpoints().empty());
  const auto shape = std::make_shared<const VertexSequence>(std::vector{1.0, 2.5}, std::vector{kVertices, kVertices});
  const Skin shaped(kVertices, joints, rows(1, {0, 0, 1}, {1, 1, 1}), shape);
  EXPECT_EQ(shaped.span().begin, 1.0);
  EXPECT_EQ(shaped.span().end, 2.5);
}

TEST(Skin, WeightsNearlyOneAreScaledAndTheirOwnStay) {
  const double nearly = 0.7 + 0.2 + 0.1;  // as rounding has it
  ASSERT_NE(nearly, 1.0);
  const Skin skin({{0, 0, 0}, {1, 0, 0}}, two_links(), rows(3, {0, 1, 0, 0, 1, 0}, {0.3, 0.70003, 0, 0.7, 0.2, 0.1}));
  const SkinWeights once = skin.weights();
  EXPECT_NEAR(once.weight[0] + once.weight[1], 1.0, kRounding);
  EXPECT_NEAR(once.weight[1] / once.weight[0], 0.70003 / 0.3, kRounding);
  EXPECT_EQ(std::vector(once.weight.begin() + 3, once.weight.end()), (std::vector<double>{0.7, 0.2, 0.1}));
  EXPECT_EQ(Skin(skin.vertices(), skin.joints(), once).weights().weight, once.weight);
}

TEST(Skin, RowsKeepOnlyWhatCounts) {
  const SkinWeights weights =
      Skin(kVertices, two_links(), rows(3, {0, 1, 0, 1, 0, 0, 0, 0, 1}, {0, 1, 0, 0.5, 0.5, 0, 0, 0, 1})).weights();
  EXPECT_EQ(weights.per_vertex, 2);
  EXPECT_EQ(weights.joint, (std::vector<uint32_t>{1, 0, 1, 0, 1, 0}));
  EXPECT_EQ(weights.weight, (std::vector<double>{1, 0, 0.5, 0.5, 1, 0}));
}

TEST(Skin, TheDominantJointHasTheLargestShareOfATriangle) {
  const Skin skin({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}}, two_links(),
                  rows(2, {0, 1, 0, 1, 0, 1, 0, 1}, {1, 0, 0.5, 0.5, 0, 1, 0.1, 0.9}));
  const std::vector<std::array<uint32_t, 3>> triangles = {{0, 0, 1}, {0, 1, 2}, {1, 2, 3}};
  EXPECT_EQ(skin.dominant_joint(triangles), (std::vector<uint32_t>{0, 0, 1}));  // the second is a tie
}

TEST(Skin, RefusesBadInputByName) {
  const std::vector<Vec3> one = {Vec3::Zero()};
  const auto make = [&](std::vector<Joint> joints, SkinWeights weights) { return [=] { Skin(one, joints, weights); }; };
  const SkinWeights good = rows(1, {0}, {1.0});
  std::vector<Joint> twice = two_links(), orphan = two_links(), flat = two_links();
  twice[1].name = "shoulder";
  orphan[0].parent = 1;
  flat[1].placement.linear().setZero();
  expect_error<Invalid>(make({}, good), {"joints", "at least one"});
  expect_error<Invalid>(make(twice, good), {"joints", "shoulder"});
  expect_error<Invalid>(make(orphan, good), {"joints", "behind their parents", "shoulder"});
  expect_error<Invalid>(make(flat, good), {"joints", "placement", "elbow"});
  expect_error<Invalid>(make(two_links(), rows(2, {0}, {1.0})), {"weights", "row for each vertex"});
  expect_error<Invalid>(make(two_links(), rows(1, {0}, {0.9})), {"weights", "add up to 1 for vertex 0", "0.9"});
  expect_error<Invalid>(make(two_links(), rows(1, {2}, {1.0})), {"joint_indices", "got 2"});
  expect_error<Invalid>(make(two_links(), rows(2, {0, 1}, {2.0, -1.0})), {"weights", ">= 0", "-1"});
  std::vector<Vec3> out;
  expect_error<Invalid>([&] { arm().at(0.0, {3}, out); }, {"indices", "got 3"});
}

}  // namespace
}  // namespace echopath::test_skin
