#include <gtest/gtest.h>

#include <stdexcept>
#include <string>

#include "cpp/label/hand_made_paths.h"
#include "cpp/support/expect_error.h"
#include "echopath/label/expressions/selection.h"

namespace echopath::test_selection {
namespace {

using namespace testing;
using Bits = std::vector<uint8_t>;

std::vector<HandMadePath> some_paths() {
  std::vector<HandMadePath> paths = random_paths(2000, 0, 5, 5);
  paths.insert(paths.end(), {{}, {{kTorso, false}}, {{kWallLeft, false}, {kTorso, true}}});
  return paths;
}

Paths make_paths_without_scene() {
  Paths paths = make_paths({{{kTorso, false}}});
  paths.scene = nullptr;
  return paths;
}

template <class Holds>
Bits bits_where(const std::vector<HandMadePath>& paths, Holds holds) {
  Bits bits;
  for (const HandMadePath& path : paths) bits.push_back(holds(path) ? 1 : 0);
  return bits;
}

TEST(Selection, TouchesTakesPathsWithAHitOnTheMesh) {
  const auto touches_arm = [](const HandMadePath& path) {
    for (const HandMadeHit& hit : path) {
      if (hit.mesh_id == kArmLeft || hit.mesh_id == kArmRight) return true;
    }
    return false;
  };
  const Bits taken = Selection::touches("pedestrian/arms").matches(make_paths(some_paths()));
  EXPECT_EQ(taken, bits_where(some_paths(), touches_arm));
}

TEST(Selection, NumBouncesCountsHits) {
  const Paths paths = make_paths(some_paths());
  const auto between = [](size_t low, size_t high) {
    const auto holds = [=](const HandMadePath& path) { return path.size() >= low && path.size() <= high; };
    return bits_where(some_paths(), holds);
  };
  EXPECT_EQ(Selection::num_bounces(2, 3).matches(paths), between(2, 3));
  EXPECT_EQ(Selection::num_bounces(2).matches(paths), between(2, 64));
  EXPECT_EQ(Selection::num_bounces(0, 0).matches(paths), between(0, 0));
}

TEST(Selection, BooleanLawsHold) {
  const Paths paths = make_paths(some_paths());
  const Selection a = Selection::touches("street/wall*"), b = "T .* D R", c = Selection::num_bounces(2, 4);
  EXPECT_EQ((~(a | b)).matches(paths), (~a & ~b).matches(paths));
  EXPECT_EQ((~(a & b)).matches(paths), (~a | ~b).matches(paths));
  EXPECT_EQ((a & (b | c)).matches(paths), ((a & b) | (a & c)).matches(paths));
  EXPECT_EQ((~~a).matches(paths), a.matches(paths));
  EXPECT_EQ((a | ~a).matches(paths), Bits(paths.offsets.size(), 1));
  EXPECT_EQ((a & ~a).matches(paths), Bits(paths.offsets.size(), 0));
  EXPECT_NE(a.matches(paths), b.matches(paths));
}

// A path expression says the same as the algebra.
TEST(Selection, AlgebraAndExpressionsAreOneLanguage) {
  const Paths paths = make_paths(some_paths());
  EXPECT_EQ((Selection::touches("pedestrian") & Selection::num_bounces(1, 1)).matches(paths),
            Selection("T 'pedestrian' R").matches(paths));
  EXPECT_EQ((~Selection::touches("street")).matches(paths), Selection("T [^ 'street']* R").matches(paths));
  EXPECT_EQ(Selection(Selection::num_bounces(2, 4).text()).matches(paths), Selection::num_bounces(2, 4).matches(paths));
}

TEST(Selection, TextReadsLikeTheAlgebra) {
  const Selection a = Selection::touches("pedestrian"), b = Selection::num_bounces(1, 1), c = Selection::num_bounces(2);
  EXPECT_EQ(a.text(), "T .* 'pedestrian' .* R");
  EXPECT_EQ(b.text(), "T .{1} R");
  EXPECT_EQ(Selection::num_bounces(0, 3).text(), "T .{0,3} R");
  EXPECT_EQ(((a | b) & ~c).text(), "((T .* 'pedestrian' .* R) | (T .{1} R)) & ~(T .{2,} R)");
  EXPECT_EQ((a | b | c).text(), "(T .* 'pedestrian' .* R) | (T .{1} R) | (T .{2,} R)");
}

// Chains in which each step is joined to all before it, from either side; a step that copied them would take minutes.
TEST(Selection, LongChainsReadAsTheyWereJoined) {
  constexpr int kLength = 60000;
  const auto term = [](int number) { return Selection::num_bounces(number % 60); };
  Selection forth = term(0), back = term(0);
  std::string forth_text = "(" + term(0).text() + ")", back_text = forth_text;
  for (int number = 1; number < kLength; ++number) {
    forth = forth | term(number);
    forth_text += " | (" + term(number).text() + ")";
    back = term(number) & back;
  }
  for (int number = 1; number < 60; ++number) back_text = "(" + term(number).text() + ") & " + back_text;
  EXPECT_EQ(forth.text(), forth_text);
  EXPECT_TRUE(back.text().ends_with(back_text));
  EXPECT_EQ(Selection(forth_text).text(), forth_text);
  const Paths paths = make_paths({{}, {{kTorso, false}}});
  EXPECT_EQ((forth & Selection::num_bounces(1)).matches(paths), (Bits{0, 1}));
  EXPECT_THROW(forth | Selection(forth_text), std::invalid_argument);  // 120 000 terms
}

TEST(Selection, WhatStandsInBothOperandsIsTakenOnce) {
  const Selection a = Selection::num_bounces(1, 1), b = Selection::num_bounces(2, 2), c = Selection::num_bounces(3);
  EXPECT_EQ((a | a).text(), a.text());
  EXPECT_EQ(((a | b) | (a | b)).text(), (a | b).text());
  EXPECT_EQ(((b | a) | (c | b)).text(), (b | a | c).text());
  EXPECT_EQ(((a & b) | (a & b)).text(), "((T .{1} R) & (T .{2} R)) | ((T .{1} R) & (T .{2} R))");  // two that read alike
  Selection sum = a;
  for (int k = 0; k < 40; ++k) sum = (sum | b) | (c | sum);  // 2^40 terms, but that they are three
  EXPECT_EQ(sum.text(), (a | b | c).text());
  Selection half = a;
  for (int k = 0; k < 15; ++k) half = (half | b) | (c | half);
  EXPECT_EQ(((half & a) & ~half & ((half & b) | half)).text(),  // each counts as more than 30 000 before it is looked at
            (((a | b | c) & a) & ~(a | b | c) & (((a | b | c) & b) | a | b | c)).text());
}

TEST(Selection, FirstAndLastAreTheEndsOfAPath) {
  const Paths paths = make_paths(some_paths());
  const auto is_wall = [](const HandMadeHit& hit) { return hit.mesh_id == kWallLeft || hit.mesh_id == kWallRight; };
  EXPECT_EQ(Selection::first("street/wall*").matches(paths),
            bits_where(some_paths(), [&](const auto& path) { return !path.empty() && is_wall(path.front()); }));
  EXPECT_EQ(Selection::last("street/wall*").matches(paths),
            bits_where(some_paths(), [&](const auto& path) { return !path.empty() && is_wall(path.back()); }));
}

TEST(Selection, JoinedTextIsTheAlgebra) {
  const Paths paths = make_paths(some_paths());
  const Selection a = "T 'pedestrian' | 'street' R", b = Selection::touches("street"), c = "T .* D R";
  const std::string street = "T .* 'street' .* R";
  EXPECT_EQ(Selection("T 'pedestrian' | 'street' R | " + street + " & ~T .* D R").matches(paths),
            (a | (b & ~c)).matches(paths));
  EXPECT_EQ(Selection("(T 'pedestrian' | 'street' R | " + street + ")&~ ~(T .* D R)").matches(paths),
            ((a | b) & c).matches(paths));
}

// The glob stands where its path expression begins in the text, not where the text does.
TEST(Selection, GlobsWithoutAMeshAreMarkedWithinJoinedText) {
  const std::string message =
      test::error_text([] { Selection("T . R | ~T 'street' 'pedestrain' R").matches(make_paths(some_paths())); });
  EXPECT_TRUE(message.ends_with("\n  T 'street' 'pedestrain' R\n             ^")) << message;
}

TEST(Selection, NoPathsGiveNoBits) {
  const Paths none = make_paths({});
  EXPECT_TRUE(Selection("T . R").matches(none).empty());
  EXPECT_TRUE((~Selection::touches("street")).matches(none).empty());
  Paths empty_scene;
  empty_scene.scene = std::make_shared<Scene>();
  EXPECT_TRUE(Selection("T .* R").matches(empty_scene).empty());
}

TEST(Selection, BadInputNamesTheArgument) {
  const auto error_of = &test::error_text;
  EXPECT_TRUE(error_of([] { Selection::touches("it's"); }).starts_with("glob: "));
  EXPECT_TRUE(error_of([] { Selection::touches(""); }).starts_with("glob: "));
  EXPECT_TRUE(error_of([] { Selection::num_bounces(-1); }).starts_with("num_bounces: "));
  EXPECT_TRUE(error_of([] { Selection::num_bounces(3, 2); }).starts_with("num_bounces: "));
  EXPECT_TRUE(error_of([] { Selection::num_bounces(65); }).starts_with("num_bounces: "));
  EXPECT_TRUE(error_of([] { Selection::first(""); }).starts_with("glob: "));
  EXPECT_TRUE(error_of([] { Selection::power(Selection::Comparison::kAbove, NAN); }).starts_with("power: "));
  EXPECT_TRUE(error_of([] { Selection("power > 0").matches(make_paths_without_scene()); }).starts_with("paths: "));
  EXPECT_TRUE(error_of([] { Selection("T ."); }).starts_with("path expression: "));
  EXPECT_TRUE(error_of([] { Selection("T . R").matches(Paths{}); }).starts_with("paths: "));
  Paths empty_scene;
  empty_scene.scene = std::make_shared<Scene>();
  const std::string message = error_of([&] { Selection::touches("wall").matches(empty_scene); });
  EXPECT_NE(message.find("the scene has no meshes"), std::string::npos) << message;
}

}  // namespace
}  // namespace echopath::test_selection
