#pragma once
// Compiles a path expression for one scene into a deterministic automaton that reads one table entry per hit.
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "echopath/base/threads/job.h"
#include "echopath/label/expressions/expression.h"
#include "echopath/record/paths.h"

namespace echopath {

constexpr int kMaxAutomatonStates = 4096;

// Returns the bit of a mesh in the words of `mesh_bits`.
inline uint64_t mesh_bit(size_t mesh_id) { return uint64_t{1} << (mesh_id % 64); }

// Reads symbols (mesh class, event): meshes that every glob or set of the expression treats alike share a class.
class Automaton {
 public:
  // mesh_names: full names by mesh ID, and behind them others that globs may take. Raises invalid_argument when a glob takes
  // no mesh (naming the nearest names) or when more than kMaxAutomatonStates states are needed.
  Automaton(const PathExpression& expression, const std::vector<std::string>& mesh_names);

  // Returns words of mesh bits (mesh_bits). Every path that is taken shares a bit with each of them: the expression takes
  // nothing without those meshes.
  const std::vector<uint64_t>& needed_bits() const { return needed_bits_; }
  int num_states() const { return num_states_; }
  int num_classes() const { return num_classes_; }

  // Returns whether the expression takes the path with these hits; bit k of `diffuse` belongs to hit k. Every mesh_id must
  // be below the number of meshes.
  bool takes(const Hit* hits, int num_hits, uint64_t diffuse) const {
    uint32_t row = 0;
    for (int k = 0; k < num_hits; ++k, diffuse >>= 1) {
      row = table_[row + symbols_[hits[k].mesh_id + 1] + static_cast<uint32_t>(diffuse & 1u)];
    }
    return table_[row + accept_column_] != 0;
  }

  // Returns the same of a path whose hits [first_edge, end_edge) lie on edges.
  bool takes_with_edges(const Hit* hits, int num_hits, int first_edge, int end_edge) const {
    uint32_t row = 0;
    for (int k = 0; k < num_hits; ++k) {
      const bool is_edge = k >= first_edge && k < end_edge;
      row = table_[row + symbols_[hits[k].mesh_id + 1] + (is_edge ? kEdgeSymbol : 0)];
    }
    return table_[row + accept_column_] != 0;
  }

  // Returns whether the expression names passes through sheets, which are hits to it then.
  bool sees_passes() const { return num_events_ > kPassSymbol; }
  // Returns the same of a path with passes, for an expression that sees them; both are -1 where no hit lies on an edge.
  bool takes_with_passes(const Hit* hits, int num_hits, uint64_t diffuse, int first_edge, int end_edge,
                         std::span<const Pass> passes) const;

  // Returns the same as `takes` faster, but may read up to kOverread hits beyond the path's own, which must be there. It
  // steps in fours, past the end with the symbol that changes nothing: most paths have one to four hits, and a branch on the
  // exact number would be mispredicted so often that it costs more than the steps.
  static constexpr int kOverread = 4;
  bool takes_in_fours(const Hit* hits, int num_hits, uint64_t diffuse) const {
    if (num_hits == 1) return takes(hits, 1, diffuse);  // well predicted where paths of one hit are many or few
    uint32_t row = 0;
    int left = num_hits;
    do {
      for (int step = 0; step < 4; ++step) {
        const auto present = static_cast<uint32_t>((step - left) >> 31);  // all bits set, none past the end
        const uint32_t symbol = symbols_[(hits[step].mesh_id + 1) & present];
        row = table_[row + symbol + (static_cast<uint32_t>(diffuse >> step) & present & 1u)];
      }
      hits += 4;
      left -= 4;
      diffuse >>= 4;
    } while (left > 0);
    return table_[row + accept_column_] != 0;
  }

 private:
  // Symbols of a class: specular, diffuse, on an edge, and a pass where the expression names passes.
  static constexpr uint32_t kEdgeSymbol = 2, kPassSymbol = 3;
  bool takes_something_without(uint32_t mesh_class) const;
  void find_needed_bits();

  std::vector<uint32_t> symbols_;  // [1 + M] the symbol that changes nothing, then num_events_ times the class of each mesh
  // [num_states, num_symbols + 2] holds where the row of the next state starts, by symbol (the one that changes nothing is
  // the last), and then 1 if the state takes the path, else 0. State 0 is the start.
  std::vector<uint32_t> table_;
  std::vector<uint64_t> needed_bits_;
  uint32_t accept_column_ = 0, num_events_ = kPassSymbol;
  int num_states_ = 0, num_classes_ = 0;
};

// Returns [P] the bits of the meshes that each path hits; bit k stands for meshes k, k + 64, ... It costs about as much as a
// `narrow`.
std::vector<uint64_t> mesh_bits(const Paths& paths, Job* job = nullptr);

// Clears among the paths that are 1 in `candidates` [P] those that the automaton does not take. With their mesh_bits it
// reads only the hits of paths that touch the meshes they must. Runs on all threads; raises Cancelled when the job is
// cancelled.
void narrow(const Automaton& automaton, const Paths& paths, std::vector<uint8_t>& candidates, Job* job = nullptr,
            const std::vector<uint64_t>& bits = {});

}  // namespace echopath
