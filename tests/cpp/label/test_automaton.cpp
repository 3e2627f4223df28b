#include <gtest/gtest.h>

#include <optional>
#include <regex>
#include <stdexcept>
#include <string>

#include "cpp/label/hand_made_paths.h"
#include "cpp/support/any_threads.h"
#include "cpp/support/expect_error.h"
#include "echopath/label/expressions/automaton.h"
#include "echopath/label/expressions/expression.h"

namespace echopath::test_automaton {
namespace {

using testing::HandMadeHit;
using testing::HandMadePath;
using namespace testing;  // the meshes of the street

std::string join(std::initializer_list<std::string> pieces) {
  std::string text;
  for (const std::string& piece : pieces) text += piece;
  return text;
}

std::vector<uint8_t> matches(const Automaton& automaton, const Paths& paths) {
  std::vector<uint8_t> taken(static_cast<size_t>(paths.num_paths()), 1);
  narrow(automaton, paths, taken);
  return taken;
}

bool takes(const std::string& text, const HandMadePath& path) {
  return matches(Automaton(parse_path_expression(text), make_street()->mesh_names()), make_paths({path})).front() != 0;
}

std::string error_of(const std::string& text) {
  return test::error_text([&] { Automaton(parse_path_expression(text), make_street()->mesh_names()); });
}

constexpr HandMadeHit kS{kFloor, false}, kD{kFloor, true};

TEST(Automaton, AnchorsHoldAtBothEnds) {
  EXPECT_TRUE(takes("T . R", {kS}));
  EXPECT_FALSE(takes("T . R", {}));
  EXPECT_FALSE(takes("T . R", {kS, kS}));
  EXPECT_TRUE(takes("T R", {}));
  EXPECT_FALSE(takes("T R", {kS}));
}

TEST(Automaton, EventsReadTheBitOfTheirHit) {
  EXPECT_TRUE(takes("T S D R", {kS, kD}));
  EXPECT_FALSE(takes("T S D R", {kD, kS}));
  EXPECT_TRUE(takes("T S'street/floor' D['pedestrian' 'street'] R", {kS, kD}));
  EXPECT_FALSE(takes("T S'street/floor' D['pedestrian' 'street'] R", {kS, kS}));
  EXPECT_FALSE(takes("T D[^ 'street/floor'] R", {kD}));
  HandMadePath longest(64, kS);
  longest.back() = kD;
  EXPECT_TRUE(takes("T S{63} D R", longest));
  EXPECT_FALSE(takes("T S+ R", longest));
}

TEST(Automaton, ChoiceBindsWeakerThanSequence) {
  EXPECT_TRUE(takes("T S S | D R", {kS, kS}));
  EXPECT_TRUE(takes("T S S | D R", {kD}));
  EXPECT_FALSE(takes("T S S | D R", {kS, kD}));
  EXPECT_TRUE(takes("T S (S | D) R", {kS, kD}));
}

TEST(Automaton, CountsAreInclusive) {
  const auto lengths_taken = [](const std::string& text) {
    std::string lengths;
    for (size_t length = 0; length < 8; ++length) {
      if (takes(text, HandMadePath(length, kS))) lengths += static_cast<char>('0' + length);
    }
    return lengths;
  };
  EXPECT_EQ(lengths_taken("T .{2} R"), "2");
  EXPECT_EQ(lengths_taken("T .{2,} R"), "234567");
  EXPECT_EQ(lengths_taken("T .{2,4} R"), "234");
  EXPECT_EQ(lengths_taken("T .{0} R"), "0");
  EXPECT_EQ(lengths_taken("T .{0,2} R"), "012");
  EXPECT_EQ(lengths_taken("T .? R"), "01");
  EXPECT_EQ(lengths_taken("T .* R"), "01234567");
  EXPECT_EQ(lengths_taken("T .+ R"), "1234567");
  EXPECT_EQ(lengths_taken("T (.{2}){1,3} R"), "246");
  EXPECT_EQ(lengths_taken("T (.{3}|.{4})* R"), "03467");
  EXPECT_EQ(lengths_taken("T (.?){2} . R"), "123");
}

TEST(Automaton, GlobsTakeNamesAndAncestors) {
  EXPECT_TRUE(takes("T 'pedestrian' R", {{kArmLeft, false}}));
  EXPECT_TRUE(takes("T 'pedestrian/arms' R", {{kArmLeft, false}}));
  EXPECT_FALSE(takes("T 'pedestrian/arms' R", {{kTorso, false}}));
  EXPECT_TRUE(takes("T 'pedestrian/*' R", {{kArmRight, true}}));
  EXPECT_TRUE(takes("T '*right' R", {{kWallRight, true}}));
  EXPECT_FALSE(takes("T '*right' R", {{kWallLeft, true}}));
}

TEST(Automaton, SetsAreUnionsAndTheirComplements) {
  for (uint32_t mesh = 0; mesh < kNumStreetMeshes; ++mesh) {
    const bool inside = mesh == kWallLeft || mesh == kArmLeft || mesh == kArmRight;
    EXPECT_EQ(takes("T ['street/wall_left' 'pedestrian/arms'] R", {{mesh, false}}), inside) << mesh;
    EXPECT_EQ(takes("T [^ 'street/wall_left' 'pedestrian/arms'] R", {{mesh, false}}), !inside) << mesh;
  }
}

TEST(Automaton, MeshesThatNoGlobTellsApartShareAClass) {
  EXPECT_EQ(Automaton(parse_path_expression("T .* R"), make_street()->mesh_names()).num_classes(), 1);
  const Automaton wall(parse_path_expression("T .* 'street/wall*' .* R"), make_street()->mesh_names());
  EXPECT_EQ(wall.num_classes(), 2);
  EXPECT_EQ(wall.num_states(), 2);
}

TEST(Automaton, GlobWithoutMeshNamesTheNearest) {
  const std::string message = error_of("T .* 'pedestrian/torzo' R");
  EXPECT_NE(message.find("nearest names: pedestrian/torso"), std::string::npos) << message;
  EXPECT_TRUE(message.ends_with("\n  T .* 'pedestrian/torzo' R\n       ^")) << message;
  EXPECT_NE(error_of("T [^ 'floor'] R").find("'floor'"), std::string::npos);
  EXPECT_NE(error_of("T 'pedestrain' R").find("nearest names: pedestrian"), std::string::npos);
}

TEST(Automaton, TooManyStatesIsAClearErrorInShortTime) {
  EXPECT_NE(error_of("T .* S .{20} R").find("at most 4096 states"), std::string::npos);  // 2^21 subsets
  EXPECT_NE(error_of("T (((S{64}){64}){64}){64} R").find("at most 4096 states"), std::string::npos);
  EXPECT_NE(error_of("T .{0,64} (.{0,64} D?){64} R").find("at most 4096 states"), std::string::npos);
  const std::string of_long_text = error_of(join({"T .* ", std::string(9000, 'S'), " R"}));
  EXPECT_TRUE(of_long_text.ends_with(join({"got T .* ", std::string(75, 'S'), "..."}))) << of_long_text.size();
  std::string nothing = "S{0}";
  for (int i = 0; i < 50; ++i) nothing = join({"(", nothing, "){64}"});
  EXPECT_TRUE(takes(join({"T ", nothing, " R"}), {}));
}

// Random expressions, written at once for Echopath and for std::regex. There each hit is one letter: mesh m is 'a' + m
// when specular and 'A' + m when diffuse. What each glob takes was worked out by hand.
struct TwinText {
  std::string expression, regex;
};
struct HandMadeGlob {
  const char* glob;
  std::vector<uint32_t> meshes;
};
const std::vector<HandMadeGlob> kGlobs{
    {"street", {kWallLeft, kWallRight, kFloor}},
    {"street/wall*", {kWallLeft, kWallRight}},
    {"street/floor", {kFloor}},
    {"pedestrian/*", {kTorso, kArmLeft, kArmRight}},
    {"pedestrian/arms", {kArmLeft, kArmRight}},
    {"*left", {kWallLeft, kArmLeft}},
    {"pedestrian/arms/righ?", {kArmRight}},
    {"*", {0, 1, 2, 3, 4, 5}},
};

class TwinGenerator {
 public:
  explicit TwinGenerator(uint32_t seed) : random_(seed) {}
  TwinText expression() {
    const TwinText body = choice(2);
    return {join({"T", space(), body.expression, space(), "R"}), body.regex};
  }

 private:
  uint32_t below(uint32_t limit) { return static_cast<uint32_t>(random_() % limit); }
  std::string space() { return std::string(below(3), ' '); }

  TwinText choice(int depth) {
    TwinText text = sequence(depth);
    for (uint32_t more = below(3); more > 1; --more) {
      const TwinText other = sequence(depth);
      text = {join({text.expression, space(), "|", space(), other.expression}), join({text.regex, "|", other.regex})};
    }
    return text;
  }
  TwinText sequence(int depth) {
    TwinText text = repeat(depth);
    for (uint32_t more = below(3); more > 0; --more) {
      const TwinText next = repeat(depth);
      text = {text.expression + " " + next.expression, text.regex + next.regex};
    }
    return text;
  }
  TwinText repeat(int depth) {
    const TwinText base = depth > 0 && below(3) == 0 ? group(depth - 1) : hit();
    const uint32_t count = below(3);
    const std::string low = std::to_string(count), high = std::to_string(count + below(3));
    const std::vector<std::string> operators{
        "", "", "", "*", "+", "?", join({"{", low, "}"}), join({"{", low, ",}"}), join({"{", low, ",", high, "}"})};
    const std::string& chosen = operators[below(static_cast<uint32_t>(operators.size()))];
    return {join({base.expression, space(), chosen}), join({"(?:", base.regex, ")", chosen})};
  }
  TwinText group(int depth) {
    const TwinText inner = choice(depth);
    return {join({"(", space(), inner.expression, space(), ")"}), join({"(?:", inner.regex, ")"})};
  }
  TwinText hit() {
    const std::vector<std::string> events{"", "S", "D"};
    const uint32_t event = below(3);
    std::vector<bool> taken(kNumStreetMeshes, true);
    std::string meshes = event == 0 ? "." : "";
    if (below(4) != 0) meshes = mesh_set(taken);
    std::string letters;
    for (uint32_t mesh = 0; mesh < kNumStreetMeshes; ++mesh) {
      if (taken[mesh] && event != 2) letters += static_cast<char>('a' + mesh);
      if (taken[mesh] && event != 1) letters += static_cast<char>('A' + mesh);
    }
    const std::string text = events[event] + meshes;
    // An event alone stands in parentheses, for a glob may follow: S 'a' is an error and S'a' one hit.
    return {meshes.empty() ? join({"(", text, ")"}) : text, letters.empty() ? "!" : join({"[", letters, "]"})};
  }
  std::string mesh_set(std::vector<bool>& taken) {
    taken.assign(kNumStreetMeshes, false);
    const uint32_t kind = below(3);  // glob, set, negated set
    std::string text;
    for (uint32_t more = kind == 0 ? 1 : 1 + below(3); more > 0; --more) {
      const HandMadeGlob& glob = kGlobs[below(static_cast<uint32_t>(kGlobs.size()))];
      for (const uint32_t mesh : glob.meshes) taken[mesh] = true;
      text += join({"'", glob.glob, "'", space()});
    }
    if (kind == 0) return text.substr(0, text.find_last_of('\'') + 1);
    if (kind == 2) taken.flip();
    return join({kind == 1 ? "[" : "[^", space(), text, "]"});
  }

  std::mt19937 random_;
};

// Random nesting may need more states than allowed; such an expression is left out.
std::optional<Automaton> compile_if_small(const std::string& text, const Paths& paths) {
  try {
    return Automaton(parse_path_expression(text), paths.scene->mesh_names());
  } catch (const std::invalid_argument& error) {
    if (std::string(error.what()).find("states") == std::string::npos) throw;
    return std::nullopt;
  }
}

std::string letters_of(const HandMadePath& path) {
  std::string letters;
  for (const HandMadeHit& hit : path) letters += static_cast<char>((hit.diffuse ? 'A' : 'a') + hit.mesh_id);
  return letters;
}

TEST(Automaton, AgreesWithStdRegexOnRandomExpressionsAndPaths) {
  constexpr int kNumExpressions = 400;
  constexpr size_t kNumPaths = 10000, kPathsPerExpression = 100;  // std::regex is slow
  constexpr uint32_t kMaxHits = 6;
  const std::vector<HandMadePath> hand_made = random_paths(kNumPaths, 0, kMaxHits, 7);
  const Paths paths = make_paths(hand_made);
  std::vector<std::string> words;
  for (const HandMadePath& path : hand_made) words.push_back(letters_of(path));

  TwinGenerator generator(11);
  size_t num_taken = 0, num_checked = 0;
  for (int i = 0; i < kNumExpressions; ++i) {
    const TwinText text = generator.expression();
    SCOPED_TRACE(text.expression + "   " + text.regex);
    const std::optional<Automaton> automaton = compile_if_small(text.expression, paths);
    if (!automaton) continue;
    const std::vector<uint8_t> taken = matches(*automaton, paths);
    const std::regex regex(text.regex);
    for (size_t k = 0; k < kPathsPerExpression; ++k) {
      const size_t path = (static_cast<size_t>(i) * kPathsPerExpression + k) % kNumPaths;
      ASSERT_EQ(taken[path] != 0, std::regex_match(words[path], regex)) << words[path];
      num_taken += taken[path];
      ++num_checked;
    }
  }
  EXPECT_GT(num_checked, kNumExpressions * kPathsPerExpression * 9 / 10);
  // Both answers must be common, else the comparison proves little.
  EXPECT_GT(num_taken, num_checked / 20);
  EXPECT_LT(num_taken, num_checked / 2);
}

TEST(Automaton, NumberOfThreadsDoesNotMatter) {
  const Paths paths = make_paths(random_paths(200000, 0, 5, 3));
  const Automaton automaton(parse_path_expression("T .* 'pedestrian' S* R"), paths.scene->mesh_names());
  test::same_on_any_threads([&] { return matches(automaton, paths); });
}

}  // namespace
}  // namespace echopath::test_automaton
