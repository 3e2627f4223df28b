#pragma once
// Names the time grid of a path.
#include <compare>
#include <cstddef>
#include <cstdint>

namespace echopath {

// There is one grid for paths that do not move, polynomials for each set of cuts (MotionCuts), by their number of nodes
// (TimeGrids), and none of these for paths that only nodes in every chirp follow. Grids stand in the order in which paths
// over meshes of one set of cuts try them; those of MotionCuts::kOfRadar come first.
class GridIndex {
 public:
  static constexpr size_t kMostPolynomials = 26;  // of a set of cuts
  constexpr GridIndex() = default;                // still
  static constexpr GridIndex still() { return {}; }
  static constexpr GridIndex polynomial(size_t number, uint32_t cuts = 0) {  // number below kMostPolynomials
    return GridIndex(kOfCuts * cuts + number + 1);
  }
  static constexpr GridIndex none() { return GridIndex(kOfCuts - 1); }
  // Returns how many places tables of all grids have.
  static constexpr size_t count(size_t num_cuts) { return kOfCuts * num_cuts; }

  constexpr bool is_polynomial() const { return *this != still() && *this != none(); }
  constexpr size_t number() const { return place_ % kOfCuts - 1; }                     // of a polynomial
  constexpr uint32_t cuts() const { return place_ / static_cast<uint32_t>(kOfCuts); }  // 0 unless it is a polynomial
  constexpr size_t place() const { return place_; }                                    // in tables of all grids
  friend constexpr auto operator<=>(GridIndex, GridIndex) = default;

 private:
  static constexpr size_t kOfCuts = kMostPolynomials + 2;
  explicit constexpr GridIndex(size_t place) : place_(static_cast<uint32_t>(place)) {}
  uint32_t place_ = 0;
};

}  // namespace echopath
