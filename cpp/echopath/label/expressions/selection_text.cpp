#include "echopath/label/expressions/selection_text.h"

#include <cctype>
#include <charconv>
#include <cmath>
#include <string>
#include <system_error>

#include "echopath/label/expressions/expression.h"

namespace echopath {
namespace {

constexpr std::string_view kPower = "power";

// Parses by recursive descent; at_ is the next byte.
class SelectionParser {
 public:
  explicit SelectionParser(std::string_view text) : text_(text) {}

  Selection parse() {
    Selection selection = parse_alternatives();
    if (!at_end()) fail("&, | or the end");
    return selection;
  }

 private:
  Selection parse_alternatives() {
    Selection selection = parse_conjunction();
    while (take("|")) selection = selection | parse_conjunction();
    return selection;
  }

  Selection parse_conjunction() {
    Selection selection = parse_operand();
    while (take("&")) selection = selection & parse_operand();
    return selection;
  }

  Selection parse_operand() {
    if (++nesting_ > kMaxNesting) fail("at most " + std::to_string(kMaxNesting) + " nested ~ and parentheses");
    Selection operand = parse_unary();
    --nesting_;
    return operand;
  }

  Selection parse_unary() {
    if (take("~")) return ~parse_operand();
    if (take("(")) return parse_parentheses();
    if (take(kPower)) return parse_power();
    if (peek() != 'T') fail("a path expression T ... R, as T .* 'name' .* R for what touches a mesh, power, ~ or (");
    return Selection::path_expression(read_path_expression(text_, at_));
  }

  Selection parse_parentheses() {
    Selection inner = parse_alternatives();
    if (!take(")")) fail("&, | or ) after it");
    return inner;
  }

  Selection parse_power() {
    using Comparison = Selection::Comparison;
    if (take("<=")) return Selection::power(Comparison::kAtMost, parse_watts());
    if (take("<")) return Selection::power(Comparison::kBelow, parse_watts());
    if (take(">=")) return Selection::power(Comparison::kAtLeast, parse_watts());
    if (take(">")) return Selection::power(Comparison::kAbove, parse_watts());
    fail("<, <=, > or >= after power");
  }

  double parse_watts() {
    skip_space();
    double watts = 0.0;
    const auto [end, fault] = std::from_chars(text_.data() + at_, text_.data() + text_.size(), watts);
    if (fault != std::errc() || !std::isfinite(watts)) fail_at_word("a power in W, such as 1e-15");
    if (watts < 0.0) fail_at_word("a power in W from 0 on, such as 1e-13 for -100 dBm");
    at_ = static_cast<size_t>(end - text_.data());
    if (std::isalpha(static_cast<unsigned char>(peek())) && peek() != 'T')
      fail_at_word("no unit, as powers are in W, such as 1e-13 for -100 dBm");
    return watts;
  }

  void skip_space() {
    while (at_ < text_.size() && is_expression_space(text_[at_])) ++at_;
  }
  bool at_end() {
    skip_space();
    return at_ >= text_.size();
  }
  char peek() { return at_end() ? '\0' : text_[at_]; }
  bool take(std::string_view symbol) {
    skip_space();
    if (text_.substr(at_, symbol.size()) != symbol) return false;
    at_ += symbol.size();
    return true;
  }
  // Quotes the whole word that is there.
  [[noreturn]] void fail_at_word(const std::string& expected) {
    skip_space();
    const std::string_view rest = text_.substr(at_), word = rest.substr(0, rest.find_first_of(" \t\r\n()&|"));
    if (word.size() <= 1) fail(expected);
    throw_expression_error(text_, at_, "expected " + expected + ", got '" + std::string(word) + "'");
  }
  [[noreturn]] void fail(const std::string& expected) {
    skip_space();
    throw_expression_error(text_, at_, "expected " + expected + ", got " + found_in_expression(text_, at_));
  }

  std::string_view text_;
  size_t at_ = 0;
  int nesting_ = 0;
};

}  // namespace

Selection parse_selection(std::string_view text) { return SelectionParser(text).parse(); }

}  // namespace echopath
