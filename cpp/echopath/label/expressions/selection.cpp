#include "echopath/label/expressions/selection.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <unordered_map>
#include <unordered_set>
#include <utility>

#include "echopath/base/errors.h"
#include "echopath/base/lanes/simd.h"
#include "echopath/label/expressions/automaton.h"
#include "echopath/label/expressions/selection_text.h"
#include "echopath/power/path_power.h"

namespace echopath {
namespace {

constexpr int64_t kMaxTerms = 100000;  // each is evaluated for all paths
constexpr int kMaxDepth = 100;         // bounds the recursion, and the memory of masks [P] at each level

}  // namespace

struct Selection::Term {
  enum class Kind { kExpression, kNumBounces, kPower, kAnd, kOr, kNot };
  Kind kind;
  PathExpression expression = {};               // kExpression
  int min = 0, max = 0;                         // kNumBounces
  Comparison comparison = Comparison::kAbove;   // kPower
  double watts = 0.0;                           // kPower
  std::vector<Selection> operands = {};         // kAnd, kOr: two or more, also of the same kind; kNot: one
  int64_t size = 1;                             // leaves as often as they are evaluated, or more where operands share some
  int depth = 1;                                // of the tree of terms, in which a chain of & or | is one
  mutable const Term* next_released = nullptr;  // that waits to be deleted behind this one

  static Selection make(Term term) {
    count(term);
    if (term.size > kMaxTerms) {
      term.operands = term.children();
      std::unordered_map<const Term*, int64_t> known;
      term.size = exact_size(term, known);
    }
    require(term.size <= kMaxTerms, "selection", "must have at most " + std::to_string(kMaxTerms) + " terms", term.size);
    require(term.depth <= kMaxDepth, "selection", "must be nested at most " + std::to_string(kMaxDepth) + " deep",
            term.depth);
    return Selection(std::shared_ptr<const Term>(new Term(std::move(term)), &release));
  }

  // Writes depth, and as size what it is at most.
  static void count(Term& term) {
    if (!term.operands.empty()) term.size = 0;
    for (const Selection& operand : term.operands) {
      term.size += operand.term_->size;
      term.depth = std::max(term.depth, operand.term_->depth + (operand.term_->kind == term.kind ? 0 : 1));
    }
  }

  // Returns the size without what stands in several operands of a chain, and remembers it in `known`.
  static int64_t exact_size(const Term& term, std::unordered_map<const Term*, int64_t>& known) {
    if (term.operands.empty()) return 1;
    int64_t& size = known[&term];  // stays where it is
    if (size > 0) return size;
    int64_t sum = 0;
    for (const Selection& child : term.children()) sum += exact_size(*child.term_, known);
    return size = sum;
  }

  // Holds the operands as they are, so that each step of a long chain costs the same. s & s is s.
  static Selection combine(Kind kind, const Selection& a, const Selection& b) {
    if (a.term_ == b.term_) return a;
    Term term{.kind = kind};
    term.operands = {a, b};
    return make(std::move(term));
  }

  // Returns what a chain of the same kind joins, in order, so that a long chain of | is one term and not a deep tree. What
  // stands in several operands is taken once.
  std::vector<Selection> children() const {
    std::vector<Selection> found;
    std::unordered_set<const Term*> taken;
    std::vector<const Selection*> left;  // the last one is next
    const auto open = [&](const Term& term) {
      for (auto operand = term.operands.rbegin(); operand != term.operands.rend(); ++operand) left.push_back(&*operand);
    };
    for (open(*this); !left.empty();) {
      const Selection& next = *left.back();
      left.pop_back();
      if (!taken.insert(next.term_.get()).second) continue;
      if (next.term_->kind == kind) open(*next.term_);
      else found.push_back(next);
    }
    return found;
  }

  // Deletes a term and then, one after the other, the operands that it was the last to hold: those of a long chain would
  // exhaust the stack if each deleted its own. They wait in a list through themselves, for which no memory can be missing.
  static void release(const Term* term) noexcept {
    thread_local const Term* waiting = nullptr;
    thread_local bool is_deleting = false;
    term->next_released = waiting;
    waiting = term;
    if (is_deleting) return;
    is_deleting = true;
    while (waiting) {
      const Term* next = waiting;
      waiting = next->next_released;
      delete next;  // calls this function for its operands
    }
    is_deleting = false;
  }
};

Selection::Selection(std::string_view text) : term_(parse_selection(text).term_) {}

Selection Selection::path_expression(PathExpression expression) {
  return Term::make({.kind = Term::Kind::kExpression, .expression = std::move(expression)});
}

namespace {

Selection around_glob(std::string_view before, std::string_view glob, std::string_view after) {
  const bool is_quotable = !glob.empty() && glob.find('\'') == std::string_view::npos;
  require(is_quotable, "glob", "must be non-empty and without quotes", glob.empty() ? "''" : glob);
  return Selection::path_expression(std::string(before).append("'").append(glob).append("'").append(after));
}

}  // namespace

Selection Selection::touches(std::string_view glob) { return around_glob("T .* ", glob, " .* R"); }
Selection Selection::first(std::string_view glob) { return around_glob("T ", glob, " .* R"); }
Selection Selection::last(std::string_view glob) { return around_glob("T .* ", glob, " R"); }

Selection Selection::num_bounces(int min, std::optional<int> max) {
  const std::string limit = std::to_string(kMaxRepeatCount);
  require(min >= 0 && min <= kMaxRepeatCount, "num_bounces", "must be 0 to " + limit + ", the longest path", min);
  const int last = max.value_or(min);
  require(last >= min && last <= kMaxRepeatCount, "num_bounces", "must be from the minimum to " + limit, last);
  return Term::make({.kind = Term::Kind::kNumBounces, .min = min, .max = max.value_or(kNoLimit)});
}

Selection Selection::power(Comparison comparison, double watts) {
  require(std::isfinite(watts) && watts >= 0.0, "power",
          "must be compared with a finite power in W from 0 on, such as 1e-13 for -100 dBm", watts);
  return Term::make({.kind = Term::Kind::kPower, .comparison = comparison, .watts = watts + 0.0});  // no -0
}

Selection operator&(const Selection& a, const Selection& b) {
  return Selection::Term::combine(Selection::Term::Kind::kAnd, a, b);
}

Selection operator|(const Selection& a, const Selection& b) {
  return Selection::Term::combine(Selection::Term::Kind::kOr, a, b);
}

Selection operator~(const Selection& a) {
  using Term = Selection::Term;
  if (a.term_->kind == Term::Kind::kNot) return a.term_->operands.front();
  return Term::make({.kind = Term::Kind::kNot, .operands = {a}});
}

namespace {

using Bits = std::vector<uint8_t>;  // [P] 1 or 0

template <class Value, class Holds>
void narrow_by(const std::vector<Value>& values, Bits& candidates, Holds holds) {
  for (size_t path = 0; path < candidates.size(); ++path) candidates[path] &= static_cast<uint8_t>(holds(values[path]));
}

void narrow_by_expression(PathTraits& paths, const PathExpression& expression, Bits& candidates, Job* job) {
  const Paths& record = paths.paths();
  require(record.scene != nullptr, "paths", "must carry a scene to match mesh names", "none");
  narrow(Automaton(expression, record.scene->all_mesh_names()), record, candidates, job, paths.mesh_bits(job));
}

// Keeps counts in [min, min + range].
ECHOPATH_INLINE void keep_counts(const uint8_t* counts, uint8_t min, uint8_t range, size_t size, uint8_t* candidates) {
  for (size_t i = 0; i < size; ++i) candidates[i] &= static_cast<uint8_t>(static_cast<uint8_t>(counts[i] - min) <= range);
}

void narrow_by_num_bounces(const Paths& paths, int min, int max, Bits& candidates) {
  const int last = max == kNoLimit ? kMaxRepeatCount : max;
  run_simd<keep_counts>(paths.num_bounces.data(), static_cast<uint8_t>(min), static_cast<uint8_t>(last - min),
                        candidates.size(), candidates.data());
}

void narrow_by_power(const std::vector<double>& power, Selection::Comparison comparison, double watts, Bits& candidates) {
  switch (comparison) {
    case Selection::Comparison::kBelow: return narrow_by(power, candidates, [=](double value) { return value < watts; });
    case Selection::Comparison::kAtMost: return narrow_by(power, candidates, [=](double value) { return value <= watts; });
    case Selection::Comparison::kAbove: return narrow_by(power, candidates, [=](double value) { return value > watts; });
    case Selection::Comparison::kAtLeast: return narrow_by(power, candidates, [=](double value) { return value >= watts; });
  }
}

void clear(Bits& bits, const Bits& cleared) {
  for (size_t path = 0; path < bits.size(); ++path) bits[path] &= static_cast<uint8_t>(~cleared[path]);
}

// Writes the fewest digits that read back as the same number.
std::string power_text(Selection::Comparison comparison, double watts) {
  constexpr std::array<const char*, 4> kSigns = {"<", "<=", ">", ">="};
  std::array<char, 32> digits{};
  const auto end = std::to_chars(digits.data(), digits.data() + digits.size(), watts).ptr;
  return std::string("power ").append(kSigns[static_cast<size_t>(comparison)]).append(" ").append(digits.data(), end);
}

std::string num_bounces_text(int min, int max) {
  std::string count = std::to_string(min);
  if (max != min) count += ',';
  if (max != min && max != kNoLimit) count += std::to_string(max);
  return std::string("T .{").append(count).append("} R");
}

}  // namespace

const std::vector<double>& PathTraits::power(Job* job) {
  if (!power_) power_ = path_power(paths_, job);
  return *power_;
}

const std::vector<uint64_t>& PathTraits::mesh_bits(Job* job) {
  if (!mesh_bits_) mesh_bits_ = for_many_ ? echopath::mesh_bits(paths_, job) : std::vector<uint64_t>();
  return *mesh_bits_;
}

std::vector<uint8_t> Selection::matches(const Paths& paths, Job* job) const {
  PathTraits traits(paths);
  Bits taken(static_cast<size_t>(paths.num_paths()), 1);
  narrow(traits, taken, job);
  return taken;
}

void Selection::narrow(PathTraits& paths, std::vector<uint8_t>& candidates, Job* job) const {
  const Term& term = *term_;
  if (job) job->throw_if_cancelled();
  switch (term.kind) {
    case Term::Kind::kExpression: return narrow_by_expression(paths, term.expression, candidates, job);
    case Term::Kind::kNumBounces: return narrow_by_num_bounces(paths.paths(), term.min, term.max, candidates);
    case Term::Kind::kPower: return narrow_by_power(paths.power(job), term.comparison, term.watts, candidates);
    default: return narrow_by_children(paths, candidates, job);
  }
}

void Selection::narrow_by_children(PathTraits& paths, std::vector<uint8_t>& candidates, Job* job) const {
  const std::vector<Selection> children = term_->children();
  if (term_->kind == Term::Kind::kAnd) {  // quick children go first and spare the expressions work
    const auto is_quick = [](const Selection& child) { return child.term_->kind == Term::Kind::kNumBounces; };
    for (const bool quick : {true, false}) {
      for (const Selection& child : children) {
        if (is_quick(child) == quick) child.narrow(paths, candidates, job);
      }
    }
    return;
  }
  Bits left = candidates;  // those that no child takes; for one child, the complement
  for (const Selection& child : children) {
    Bits taken = left;
    child.narrow(paths, taken, job);
    clear(left, taken);
  }
  if (term_->kind == Term::Kind::kNot) candidates = std::move(left);
  else clear(candidates, left);
}

void Selection::check_globs(const std::vector<std::string>& mesh_names) const {
  if (term_->kind == Term::Kind::kExpression) Automaton(term_->expression, mesh_names);
  for (const Selection& child : term_->children()) child.check_globs(mesh_names);
}

std::string Selection::text() const {
  const Term& term = *term_;
  if (term.kind == Term::Kind::kExpression) return term.expression.text;
  if (term.kind == Term::Kind::kPower) return power_text(term.comparison, term.watts);
  if (term.kind == Term::Kind::kNumBounces) return num_bounces_text(term.min, term.max);
  std::string joined = term.kind == Term::Kind::kNot ? "~" : "";
  const std::vector<Selection> children = term.children();
  for (size_t child = 0; child < children.size(); ++child) {
    if (child > 0) joined += term.kind == Term::Kind::kAnd ? " & " : " | ";
    const Selection& operand = children[child];
    const bool bare = operand.term_->kind == Term::Kind::kNot;
    joined += bare ? operand.text() : std::string("(").append(operand.text()).append(")");
  }
  return joined;
}

}  // namespace echopath
