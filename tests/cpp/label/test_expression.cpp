#include <gtest/gtest.h>

#include <string>

#include "cpp/support/expect_error.h"
#include "echopath/label/expressions/expression.h"

namespace echopath::test_expression {
namespace {

std::string error_of(const std::string& text) {
  return test::error_text([&] { parse_path_expression(text); });
}

// The caret points at the first '@' of `marked`; the expression is `marked` without it.
void expect_fault_at(std::string marked, const std::string& expected) {
  const size_t position = marked.find('@');
  ASSERT_NE(position, std::string::npos) << marked;
  marked.erase(position, 1);
  const std::string message = error_of(marked);
  const std::string picture = "\n  " + marked + "\n  " + std::string(position, ' ') + "^";
  EXPECT_TRUE(message.ends_with(picture)) << message << "\nwanted:" << picture;
  EXPECT_NE(message.find("expected " + expected), std::string::npos) << message;
}

TEST(PathExpressionSyntax, KeepsItsText) {
  const std::string text = " T 'street/wall*' ( S+ | D'a b' ) {2, 3} R\n";
  EXPECT_EQ(parse_path_expression(text).text, text);
}

TEST(PathExpressionSyntax, TreeFollowsTheGrammar) {
  const Syntax body = parse_path_expression("T S'wall' | [^ 'a*' 'b']{2,} . R").body;
  ASSERT_EQ(body.kind, Syntax::Kind::kChoice);
  ASSERT_EQ(body.children.size(), 2u);
  const HitPattern& wall = body.children[0].hit;
  EXPECT_EQ(wall.event, HitPattern::Event::kSpecular);
  ASSERT_EQ(wall.globs.size(), 1u);
  EXPECT_EQ(wall.globs[0].text, "wall");
  EXPECT_EQ(wall.globs[0].position, 3u);
  const Syntax& sequence = body.children[1];
  ASSERT_EQ(sequence.kind, Syntax::Kind::kSequence);
  ASSERT_EQ(sequence.children.size(), 2u);
  EXPECT_EQ(sequence.children[0].kind, Syntax::Kind::kRepeat);
  EXPECT_EQ(sequence.children[0].min, 2);
  EXPECT_EQ(sequence.children[0].max, kNoLimit);
  const HitPattern& set = sequence.children[0].children.front().hit;
  EXPECT_TRUE(set.negated);
  ASSERT_EQ(set.globs.size(), 2u);
  EXPECT_EQ(set.globs[1].text, "b");
}

TEST(PathExpressionSyntax, CaretStandsUnderTheFault) {
  const std::string hit = "a hit (. 'mesh' S D E P [...])";
  expect_fault_at("@", "T");
  expect_fault_at("@'wall' R", "T");
  expect_fault_at("T@", hit + ", '(' or R");
  expect_fault_at("T .@", hit + ", '(', '|' or R");
  expect_fault_at("T . @& . R", hit + ", '(', '|' or R");
  expect_fault_at("T . @T R", hit);
  expect_fault_at("T . @) R", hit);
  expect_fault_at("T . R @R", "the end after R");
  expect_fault_at("T . R @| T . . R", "the end after R");
  expect_fault_at("T @| . R", hit + " or '('");
  expect_fault_at("T . | @R", hit + " or '('");
  expect_fault_at("T (@) R", hit + " or '('");
  expect_fault_at("T (. @R", hit + ", '(', '|' or ')'");
  expect_fault_at("T @\"wall\" R", hit);
  expect_fault_at("T @s R", hit);
}

TEST(PathExpressionSyntax, CaretStandsUnderBadGlobsAndSets) {
  expect_fault_at("T @'wall R", "a closing quote");
  expect_fault_at("T @'' R", "a mesh name or glob between the quotes");
  expect_fault_at("T [@] R", "a quoted glob");
  expect_fault_at("T [^@] R", "a quoted glob");
  expect_fault_at("T [@wall] R", "a quoted glob");
  expect_fault_at("T ['a' @R", "a quoted glob or ']'");
  expect_fault_at("T ['a' @^ 'b'] R", "a quoted glob or ']'");
  expect_fault_at("T S @'wall' R", "no white space here");
  expect_fault_at("T D @['wall'] R", "no white space here");
}

TEST(PathExpressionSyntax, CaretStandsUnderBadRepeats) {
  expect_fault_at("T @* R", "a hit or ')' before this operator");
  expect_fault_at("T . | @{2} R", "a hit or ')' before this operator");
  expect_fault_at("T .+@? R", "parentheses around a repeat");
  expect_fault_at("T .{2}@{3} R", "parentheses around a repeat");
  expect_fault_at("T .{@} R", "a number");
  expect_fault_at("T .{@-1} R", "a number");
  expect_fault_at("T .{2@;3} R", "',' or '}'");
  expect_fault_at("T .{2,@x} R", "a number or '}'");
  expect_fault_at("T .{2,3 @R", "'}'");
  expect_fault_at("T .{3,@2} R", "n >= m");
  expect_fault_at("T .{@65} R", "a count of at most 64");
  expect_fault_at("T .{1,@99999999999999999999} R", "a count of at most 64");
}

TEST(PathExpressionSyntax, CaretCountsCharactersAndLines) {
  // clang-format off
  EXPECT_TRUE(error_of("T 'stra\xc3\x9f" "e' & R").ends_with("\n  T 'stra\xc3\x9f" "e' & R\n             ^"));
  // clang-format on
  EXPECT_NE(error_of("T . \xc3\x9f R").find("got \xc3\x9f\n"), std::string::npos);
  EXPECT_TRUE(error_of("T 'a'\n\t. & R\n").ends_with("\n  \t. & R\n  \t  ^"));
}

TEST(PathExpressionSyntax, DeepNestingIsAnErrorAndNotACrash) {
  const std::string deep(1000000, '(');
  EXPECT_NE(error_of("T " + deep).find("nested parentheses"), std::string::npos);
  const std::string allowed = std::string(100, '(') + "." + std::string(100, ')');
  EXPECT_NO_THROW(parse_path_expression("T " + allowed + " R"));
  std::string beside;  // is not nested, however many there are
  for (int i = 0; i < 101; ++i) beside += "(.)";
  EXPECT_NO_THROW(parse_path_expression("T " + beside + " R"));
}

}  // namespace
}  // namespace echopath::test_expression
