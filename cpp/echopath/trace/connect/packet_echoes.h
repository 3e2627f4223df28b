#pragma once
// Finds the echoes of plain first hits in all lanes at once: such a hit lies on no flagged mirror and has only straight
// legs.
#include "echopath/record/blocks/path_block.h"
#include "echopath/record/near_antenna.h"
#include "echopath/trace/sbr/first_hits.h"

namespace echopath {

// Returns whether the hit of a lane is plain, where all legs are straight.
inline bool is_plain(const FirstHits& first, int lane) {
  return !first.models[lane]->material().mirror && reaches_antenna_by_square(first.near_squared[lane]);
}

// Holds the weights of the coherent and of the diffuse echo to the receiver.
struct EchoWeights {
  LanesOf<float> field_re, field_im, power_re, power_im;

  std::complex<float> field(int lane) const { return {field_re[lane], field_im[lane]}; }
  std::complex<float> power(int lane) const { return {power_re[lane], power_im[lane]}; }
};

// This policy and the next (weight.h) find the echoes of all lanes, and add those of a lane over the first hit of the
// current ray.
class ScalarEchoes {
 public:
  void find(const FirstHits& first, const Vec3& receiver);
  void add(const FirstHits& first, int lane, PathBlock& block) const {
    if (first.receiver[lane] != ShadowState::kOpen) return;
    if (first.coherent[lane] > 0) block.add_prefix(1, 0, weights_.field(lane), first.places.strata[lane]);
    if (first.diffuse[lane] > 0) block.add_prefix(1, 1, weights_.power(lane), first.places.strata[lane]);
  }

 private:
  EchoWeights weights_;
};

// Holds the modes from which the matrices of both echoes are made.
struct LaneModes {
  LaneValues te_re, te_im, tm_re, tm_im;           // reflection coefficients
  LaneValues cross_share, axis_cosine, axis_sine;  // of diffuse hits
};

using LaneMatrices = LanesOf<float>[4][2];  // [entry][re, im]

class JonesEchoes {
 public:
  void find(const FirstHits& first, const Vec3& receiver);
  void add(const FirstHits& first, int lane, PathBlock& block) const;

 private:
  void find_modes(const FirstHits& first, int lane);

  LaneModes modes_;
  EchoWeights weights_;  // without coefficients, which are in the matrices
  LaneMatrices field_matrices_, power_matrices_;
};

}  // namespace echopath
