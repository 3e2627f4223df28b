#pragma once
// Finds which frusta may light a point: it divides the space about the mirrors into cells, each with the frusta that reach
// into it.
#include <span>
#include <vector>

#include "echopath/trace/frusta/mirror_frusta.h"

namespace echopath {

class FrustumLocator {
 public:
  FrustumLocator() = default;
  // `radius` is in m, as in MirrorFrustum::reaches.
  FrustumLocator(std::span<const MirrorFrustum> frusta, double radius);
  // Returns the indices of all frusta into which a ball about the point reaches, and of some others; ascending.
  std::span<const int> near(const Vec3& point) const;

 private:
  struct Cell {
    int axis = -1;              // along which it is halved, -1: not
    double split = 0.0;         // m
    int second = 0;             // the half above; the one below follows this cell
    size_t begin = 0, end = 0;  // in entries_
  };
  struct Regions {  // of the frusta, side by side
    std::vector<HalfSpace> halves;
    std::vector<size_t> begin;  // [frusta + 1] into halves

    std::span<const HalfSpace> of(int frustum) const {
      return {halves.data() + begin[frustum], begin[frustum + 1] - begin[frustum]};
    }
  };
  struct Growth;
  static Growth half_of(const Regions& regions, const Growth& whole, const Eigen::AlignedBox3d& box);
  void end_with(const Growth& cell, size_t index);
  int grow(const Regions& regions, Growth cell);

  Eigen::AlignedBox3d box_;  // of all cells
  std::vector<int> all_;     // frusta that may reach a point outside of the box
  std::vector<Cell> cells_;
  std::vector<int> entries_;
};

}  // namespace echopath
