#pragma once
// Estimates how well a sum over the rays of a lattice is known, from how much neighbouring rays differ.

namespace echopath {

// Takes what the rays of a lattice send back, ray by ray along its rows, and estimates the variance of the sum.
//
// Let g1 be half the sum of squared differences between next neighbours of a row, and g2 that between every other ray; rays
// that send nothing back count as 0. Where neighbours are independent, as in the crown of a tree, g2 = g1, and the lattice
// is no better than directions at random: the variance is g1. Where the power changes at outlines that are far apart, g2 =
// 2 g1, and the lattice errs less. Between them the variance is kAtOutlines^s g1, with g2 = 2^s g1 and s in 0 to 1, as for a
// surface whose semivariogram rises with that power of the distance (Matheron 1963).
class RowDifferences {
 public:
  // Adds to the power, W, of the ray at a place of its row (place_in_row), or to the size of its field, sqrt(W). Rays come
  // in the order of the record.
  void add(int place, double power);
  // Returns the variance of the sum of all that was added, W^2, or W of fields.
  double variance() const;
  // Returns the same without what changes evenly from ray to ray, over which a lattice errs little: slopes have g2 = 4 g1.
  double variance_of_jumps() const;

 private:
  void push(double power);
  void end_ray();
  RowDifferences ended() const;
  double variance_of(double next) const;

  int place_ = 0;                     // of the ray that may get more; 0: none yet
  double open_ = 0.0;                 // W, of that ray
  double before_ = 0.0, last_ = 0.0;  // W, of the two rays before
  double next_ = 0.0, second_ = 0.0;  // W^2, g1 and g2
};

}  // namespace echopath
