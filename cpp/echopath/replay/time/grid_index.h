#pragma once
// Names the time grid of a path.
#include <compare>
#include <cstddef>
#include <cstdint>

namespace echopath {

// Grids stand in the order in which paths try them: that of paths that do not move, polynomials by their number of nodes
// (TimeGrids), and none of these for paths that only nodes in every chirp follow.
class GridIndex {
 public:
  static constexpr size_t kMostPolynomials = 26, kCount = kMostPolynomials + 2;
  constexpr GridIndex() = default;  // still
  static constexpr GridIndex still() { return {}; }
  static constexpr GridIndex polynomial(size_t number) { return GridIndex(number + 1); }  // below kMostPolynomials
  static constexpr GridIndex none() { return GridIndex(kCount - 1); }

  constexpr bool is_polynomial() const { return *this != still() && *this != none(); }
  constexpr size_t number() const { return place_ - size_t{1}; }  // of a polynomial
  constexpr size_t place() const { return place_; }               // in tables of all grids, below kCount
  friend constexpr auto operator<=>(GridIndex, GridIndex) = default;

 private:
  explicit constexpr GridIndex(size_t place) : place_(static_cast<uint8_t>(place)) {}
  uint8_t place_ = 0;
};

}  // namespace echopath
