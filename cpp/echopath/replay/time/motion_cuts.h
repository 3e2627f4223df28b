#pragma once
// Finds where the motions of meshes change from one cubic to the next, and which meshes change at the same times.
#include <cstdint>
#include <map>
#include <utility>
#include <vector>

#include "echopath/radar/radar.h"
#include "echopath/scene/scene.h"

namespace echopath {

// Holds the times (s, ascending, inside a frame) at which some motions change. Between breakpoints they are smooth, between
// knots analytic: knots are the breakpoints and the knots of splines. Across a knot, where a third derivative jumps, the
// error of a polynomial falls with the cube of its order; between knots it falls geometrically.
struct Cuts {
  std::vector<double> breakpoints, knots;
  friend auto operator<=>(const Cuts&, const Cuts&) = default;
};

// Names a few sets of cuts by their index: those of the meshes and of their unions. A path has the cuts of the meshes that
// it touches, so its signal does not depend on how other objects move. The radar's cuts are in every set.
class MotionCuts {
 public:
  static constexpr uint32_t kOfRadar = 0;  // index of the set that has the cuts of the radar alone

  MotionCuts(const Scene& scene, const Radar& radar, const TimeSpan& frame);
  size_t size() const { return sets_.size(); }
  const Cuts& operator[](uint32_t index) const { return sets_[index]; }
  uint32_t of_mesh(uint32_t mesh_id) const { return of_mesh_[mesh_id]; }
  // Returns the index of the union of two sets, which may be new.
  uint32_t join(uint32_t a, uint32_t b);
  // Returns the same index, for two sets that were joined before. Many threads may ask at a time.
  uint32_t joined(uint32_t a, uint32_t b) const;

 private:
  uint32_t index_of(Cuts cuts);
  static std::pair<uint32_t, uint32_t> in_order(uint32_t a, uint32_t b) { return std::minmax(a, b); }

  std::vector<Cuts> sets_;
  std::vector<uint32_t> of_mesh_;  // by mesh ID
  std::map<Cuts, uint32_t> index_;
  std::map<std::pair<uint32_t, uint32_t>, uint32_t> joined_;  // neither is that of the radar alone
};

}  // namespace echopath
