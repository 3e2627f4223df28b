#pragma once
// A selection says which paths of a trace are meant: path expressions and their and, or, not. It is one language for select,
// partition and decompose.
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "echopath/base/threads/job.h"
#include "echopath/label/expressions/expression.h"
#include "echopath/record/paths.h"

namespace echopath {

// Holds paths and what several selections of them need, computed when it is first asked for.
class PathTraits {
 public:
  // `paths` must outlive this. `for_many` says that enough selections will follow to be worth the mesh bits.
  explicit PathTraits(const Paths& paths, bool for_many = false) : paths_(paths), for_many_(for_many) {}

  const Paths& paths() const { return paths_; }
  const std::vector<double>& power(Job* job);        // [P] W
  const std::vector<uint64_t>& mesh_bits(Job* job);  // label/expressions/automaton.h; empty unless for_many

 private:
  const Paths& paths_;
  bool for_many_;
  std::optional<std::vector<double>> power_;
  std::optional<std::vector<uint64_t>> mesh_bits_;
};

// Holds a selection as an immutable value that is cheap to copy. It refers to meshes by name alone, so it serves any scene
// that has meshes of these names.
class Selection {
 public:
  // Takes text as label/expressions/selection_text.h has it. Implicit, so that text may stand wherever a selection is asked
  // for.
  Selection(std::string_view text);
  Selection(const std::string& text) : Selection(std::string_view(text)) {}
  Selection(const char* text) : Selection(std::string_view(text)) {}

  static Selection path_expression(PathExpression expression);
  // Takes a path expression and nothing else (label/expressions/expression.h).
  static Selection path_expression(std::string_view text) { return path_expression(parse_path_expression(text)); }
  // Takes paths with at least one hit on a mesh that the glob takes: T .* 'glob' .* R.
  static Selection touches(std::string_view glob);
  // Takes paths of min to max hits, both included; without max any number from min on. 0 <= min <= max <= 64.
  static Selection num_bounces(int min, std::optional<int> max = std::nullopt);
  // Take paths with their first (last) hit on a mesh that the glob takes: T 'glob' .* R (T .* 'glob' R).
  static Selection first(std::string_view glob);
  static Selection last(std::string_view glob);
  // Takes paths whose power (power/path_power.h) compares so with a finite power in W.
  enum class Comparison { kBelow, kAtMost, kAbove, kAtLeast };
  static Selection power(Comparison comparison, double watts);

  // What both have is taken once. Each step of a chain costs the same, however long it is. Raise invalid_argument beyond
  // 100 000 terms, or 100 levels.
  friend Selection operator&(const Selection& a, const Selection& b);
  friend Selection operator|(const Selection& a, const Selection& b);
  friend Selection operator~(const Selection& a);

  // Returns [P] 1 where the path is selected, else 0. Raises invalid_argument when a glob takes no mesh of the paths' scene,
  // and Cancelled when the job is cancelled.
  std::vector<uint8_t> matches(const Paths& paths, Job* job = nullptr) const;
  // Clears among the paths that are 1 in `candidates` [P] those that are not selected. What several selections of the same
  // paths share is computed once.
  void narrow(PathTraits& paths, std::vector<uint8_t>& candidates, Job* job) const;
  // Raises invalid_argument when a glob takes none of these meshes (full names), as `matches` would.
  void check_globs(const std::vector<std::string>& mesh_names) const;
  // Returns the text as written; combined selections read as (T . R) & ~(T .* 'wall' .* R).
  std::string text() const;

 private:
  struct Term;
  void narrow_by_children(PathTraits& paths, std::vector<uint8_t>& candidates, Job* job) const;
  explicit Selection(std::shared_ptr<const Term> term) : term_(std::move(term)) {}
  std::shared_ptr<const Term> term_;
};

}  // namespace echopath
