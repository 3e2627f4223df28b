// Which edges a wave meets one after the other over flat faces.
#include "echopath/trace/edges/edge_sequences.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "cpp/support/scenes.h"
#include "echopath/record/hit_points.h"

namespace echopath::test_edge_sequences {
namespace {

using namespace testing;

constexpr double kWavelength = 0.004;  // m: faces of up to 0.16 m carry waves
constexpr double kSingle = 1e-8;       // m: single precision of the coordinates on a triangle

void add_plate(Scene& scene, const std::string& name, double from, double to) {
  add_rectangle(scene, name, {from, 0, 0}, {to - from, 0, 0}, {0, 0.1, 0}, share(Material::metal()));
}

struct Found {
  uint32_t mesh_id;
  Vec3 point, of_hit;  // m: where the second edge is met, and where the hit says so
};

// Follows a wave from the point (0, 0.02, 0) of the edge at x = 0 over one face.
std::vector<Found> found_from_left_edge(const Scene& scene, const Vec3& in) {
  const PosedScene pose(scene, 0.0);
  const std::vector<PosedEdge> edges = posed_edges(scene, pose, Vec3::Zero());
  const auto first = std::ranges::find_if(edges, [](const PosedEdge& edge) { return edge.from[0] == 0 && edge.to[0] == 0; });
  std::vector<Found> found;
  EdgeSequences(edges, kWavelength)
      .follow(first - edges.begin(), {}, {0, 0.02, 0}, in, 2, [&](const EdgeSequence& sequence, size_t last) {
    const Hit& hit = sequence.hits.back();
    EXPECT_EQ(hit.mesh_id, edges[last].mesh_id);
    found.push_back(
        {hit.mesh_id, sequence.edges.back().point, hit_point(pose.world_triangle(hit.mesh_id, hit.triangle_id), hit)});
    return true;
  });
  return found;
}

// On the cone of the edge, a wave that comes in 30 degrees off the normal of the edge keeps this angle over the face.
TEST(EdgeSequences, AWaveMeetsTheNearestEdgeOfItsPlane) {
  const Vec3 in(0, 0.5, -std::sqrt(0.75));
  for (const bool is_far_first : {true, false}) {
    Scene scene;
    if (is_far_first) add_plate(scene, "far", 0.06, 0.11);
    add_plate(scene, "near", 0.0, 0.05);
    if (!is_far_first) add_plate(scene, "far", 0.06, 0.11);
    const std::vector<Found> found = found_from_left_edge(scene, in);
    ASSERT_EQ(found.size(), 1u);
    EXPECT_EQ(found[0].mesh_id, is_far_first ? 1u : 0u);
    const Vec3 wanted(0.05, 0.02 + 0.05 / std::sqrt(3.0), 0);
    EXPECT_LT((found[0].point - wanted).norm(), kSingle);
    EXPECT_LT((found[0].of_hit - wanted).norm(), kSingle);
  }
}

// Another triangle of the mesh goes on over a part of the side.
TEST(EdgeSequences, AHitLiesOnTheStretchOfTheSideThatIsAnEdge) {
  Scene scene;
  const std::vector<Vec3> vertices = {{0, 0, 0},       {0.05, 0, 0},    {0.05, 0.1, 0}, {0, 0.1, 0},
                                      {0.05, 0.06, 0}, {0.09, 0.08, 0}, {0.05, 0.1, 0}};
  add_mesh(scene, "plate", vertices, {{0, 1, 2}, {0, 2, 3}, {4, 5, 6}}, share(Material::metal()));
  const std::vector<Found> found = found_from_left_edge(scene, -Vec3::UnitZ());
  ASSERT_EQ(found.size(), 1u);
  EXPECT_LT((found[0].point - Vec3(0.05, 0.02, 0)).norm(), kSingle);
  EXPECT_LT((found[0].of_hit - found[0].point).norm(), kSingle);
}

}  // namespace
}  // namespace echopath::test_edge_sequences
