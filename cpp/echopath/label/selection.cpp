#include "echopath/label/selection.h"

#include <utility>

#include "echopath/base/errors.h"
#include "echopath/label/automaton.h"
#include "echopath/label/expression.h"

namespace echopath {

struct Selection::Term {
  enum class Kind { kExpression, kNumBounces, kAnd, kOr, kNot };
  Kind kind;
  PathExpression expression;         // kExpression
  int min = 0, max = 0;              // kNumBounces
  std::vector<Selection> children;   // kAnd, kOr: two or more, kNot: one

  // Children of the same kind are taken over, so that a long chain of | is one term and not a deep tree.
  static Selection combine(Kind kind, const Selection& a, const Selection& b) {
    Term term{kind, {}, 0, 0, {}};
    for (const Selection& operand : {a, b}) {
      const Term& inner = *operand.term_;
      if (inner.kind == kind) term.children.insert(term.children.end(), inner.children.begin(), inner.children.end());
      else term.children.push_back(operand);
    }
    return Selection(std::make_shared<const Term>(std::move(term)));
  }
};

Selection::Selection(std::string_view path_expression)
    : term_(std::make_shared<const Term>(
          Term{Term::Kind::kExpression, parse_path_expression(path_expression), 0, 0, {}})) {}

Selection Selection::touches(std::string_view glob) {
  const bool is_quotable = !glob.empty() && glob.find('\'') == std::string_view::npos;
  require(is_quotable, "glob", "must be non-empty and without quotes", glob);
  return Selection(std::string("T .* '").append(glob).append("' .* R"));
}

Selection Selection::num_bounces(int min, std::optional<int> max) {
  const std::string limit = std::to_string(kMaxRepeatCount);
  require(min >= 0 && min <= kMaxRepeatCount, "num_bounces", "must be 0 to " + limit + ", the longest path", min);
  const int last = max.value_or(min);
  require(last >= min && last <= kMaxRepeatCount, "num_bounces", "must be from the minimum to " + limit, last);
  return Selection(std::make_shared<const Term>(Term{Term::Kind::kNumBounces, {}, min, max.value_or(kNoLimit), {}}));
}

Selection operator&(const Selection& a, const Selection& b) {
  return Selection::Term::combine(Selection::Term::Kind::kAnd, a, b);
}

Selection operator|(const Selection& a, const Selection& b) {
  return Selection::Term::combine(Selection::Term::Kind::kOr, a, b);
}

Selection operator~(const Selection& a) {
  using Term = Selection::Term;
  if (a.term_->kind == Term::Kind::kNot) return a.term_->children.front();
  return Selection(std::make_shared<const Term>(Term{Term::Kind::kNot, {}, 0, 0, {a}}));
}

namespace {

std::vector<uint8_t> matches_num_bounces(const Paths& paths, int min, int max) {
  std::vector<uint8_t> taken(paths.num_bounces.size());
  for (size_t path = 0; path < taken.size(); ++path) {
    const int count = paths.num_bounces[path];
    taken[path] = count >= min && (max == kNoLimit || count <= max);
  }
  return taken;
}

std::vector<uint8_t> matches_expression(const Paths& paths, const PathExpression& expression, Job* job) {
  require(paths.scene != nullptr, "paths", "must carry a scene to match mesh names", "none");
  return matches(Automaton(expression, paths.scene->mesh_names()), paths, job);
}

std::string num_bounces_text(int min, int max) {
  std::string count = std::to_string(min);
  if (max != min) count += ',';
  if (max != min && max != kNoLimit) count += std::to_string(max);
  return std::string("T .{").append(count).append("} R");
}

}  // namespace

std::vector<uint8_t> Selection::matches(const Paths& paths, Job* job) const {
  const Term& term = *term_;
  if (job) job->throw_if_cancelled();
  if (term.kind == Term::Kind::kExpression) return matches_expression(paths, term.expression, job);
  if (term.kind == Term::Kind::kNumBounces) return matches_num_bounces(paths, term.min, term.max);

  std::vector<uint8_t> taken = term.children.front().matches(paths, job);
  for (size_t child = 1; child < term.children.size(); ++child) {
    const std::vector<uint8_t> other = term.children[child].matches(paths, job);
    for (size_t path = 0; path < taken.size(); ++path) {
      taken[path] = term.kind == Term::Kind::kAnd ? taken[path] & other[path] : taken[path] | other[path];
    }
  }
  if (term.kind == Term::Kind::kNot) {
    for (uint8_t& bit : taken) bit ^= 1u;
  }
  return taken;
}

std::string Selection::text() const {
  const Term& term = *term_;
  if (term.kind == Term::Kind::kExpression) return term.expression.text;
  if (term.kind == Term::Kind::kNumBounces) return num_bounces_text(term.min, term.max);
  std::string joined = term.kind == Term::Kind::kNot ? "~" : "";
  for (size_t child = 0; child < term.children.size(); ++child) {
    if (child > 0) joined += term.kind == Term::Kind::kAnd ? " & " : " | ";
    const Selection& operand = term.children[child];
    const bool bare = operand.term_->kind == Term::Kind::kNot;
    joined += bare ? operand.text() : std::string("(").append(operand.text()).append(")");
  }
  return joined;
}

}  // namespace echopath
