#include <gtest/gtest.h>

#include <vector>

#include "echopath/label/expressions/automaton.h"

namespace echopath::test_passes {
namespace {

enum MeshId : uint32_t { kPane, kBall, kWall };
const std::vector<std::string> kNames = {"pane", "ball", "wall"};

Pass pass_of(MeshId mesh, uint32_t leg) { return {Hit(mesh, 0, 0.0f, 0.0f), leg}; }

// Goes through the pane to the ball, over the wall and back through the pane.
struct WayThroughPane {
  std::vector<Hit> hits = {Hit(kBall, 0, 0.0f, 0.0f), Hit(kWall, 0, 0.0f, 0.0f)};
  std::vector<Pass> passes = {pass_of(kPane, 0), pass_of(kPane, 2)};

  bool is_taken_by(const char* text) const {
    const Automaton automaton(parse_path_expression(text), kNames);
    const uint64_t diffuse = 1;  // the ball
    if (automaton.sees_passes()) return automaton.takes_with_passes(hits.data(), 2, diffuse, -1, -1, passes);
    return automaton.takes(hits.data(), 2, diffuse);
  }
};

TEST(Passes, AreHitsInOrderOfTravelWhereAnExpressionNamesThem) {
  const WayThroughPane way;
  for (const char* text : {"T P'pane' 'ball' 'wall' P'pane' R", "T P D S P R", "T P .* R", "T . . . P R", "T P'pane' .* R",
                           "T .* D'ball' .* P R", "T 'pane' . . P R", "T (P) [^ 'pane']{2} P R"}) {
    EXPECT_TRUE(way.is_taken_by(text)) << text;
  }
  for (const char* text :
       {"T P . R", "T P'ball' .* R", "T P P .* R", "T S'pane' .* P R", "T . P .* R", "T P'pane' 'ball' 'wall' R"}) {
    EXPECT_FALSE(way.is_taken_by(text)) << text;
  }
}

TEST(Passes, AreNothingToOtherExpressions) {
  const WayThroughPane way;
  for (const char* text : {"T . . R", "T 'ball' 'wall' R", "T D S R", "T [^ 'pane']+ R"})
    EXPECT_TRUE(way.is_taken_by(text)) << text;
  for (const char* text : {"T .* 'pane' .* R", "T . R"}) EXPECT_FALSE(way.is_taken_by(text)) << text;
}

TEST(Passes, NoneOfThemIsNamedToo) {
  const WayThroughPane way;
  for (const char* text : {"T P{0} . . R", "T P'pane'{0} .{2} R", "T . . (P | 'pane'){0} R"}) {
    EXPECT_TRUE(Automaton(parse_path_expression(text), kNames).sees_passes()) << text;
    EXPECT_FALSE(way.is_taken_by(text)) << text;
  }
}

TEST(Passes, ExpressionsThatNameThemReadOtherPathsAsEver) {
  const Automaton automaton(parse_path_expression("T P* D'ball' S'wall' P* R"), kNames);
  const WayThroughPane way;
  EXPECT_TRUE(automaton.sees_passes());
  EXPECT_TRUE(automaton.takes(way.hits.data(), 2, 1));
  EXPECT_FALSE(automaton.takes(way.hits.data(), 2, 2));
}

}  // namespace
}  // namespace echopath::test_passes
