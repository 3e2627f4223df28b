#pragma once
// Everything that the paths of a block share, at all nodes: posed points, images of antennas, legs, inner parts.
#include <span>

#include "echopath/replay/amplitude.h"
#include "echopath/replay/chain_plan.h"
#include "echopath/replay/node_rows.h"

namespace echopath {

// Distinct points of a block; rows by node.
struct PosedPoints {
  enum Row { kPosition, kNormal = 3, kAreaRatio = 6, kNumRows = 7 };  // three rows each of the vectors: m; unit
  NodeRows rows;

  PosedHit at(size_t point, size_t node) const;
};
PosedPoints pose_points(const ChainPlan& plan, const Localiser& localise, std::span<const Instant> instants);

// Antennas of one end as they are seen over mirrors: a leg is a straight line from one of them.
struct AntennaImages {
  enum Row { kPosition, kBoresight = 3, kNumRows = 6 };  // m, relative to the origin; unit
  size_t num_antennas = 0;
  std::vector<const AntennaPattern*> pattern;  // [antenna]
  NodeRows rows;                               // of image * num_antennas + antenna
  // Directions toward the image -> axes of the antenna, [image, antenna, node]; empty where no pattern needs it.
  std::vector<Mat3> antenna_from_image;
};
AntennaImages pose_images(const ChainPlan& plan, const Localiser& localise, std::span<const Instant> instants, bool of_receivers);

// All legs of a block, to each antenna of their end.
struct ChainLegs {
  // Length in m. Of legs to diffuse points the factor of the amplitude (diffuse_chain.h), signed as the cosine there; of
  // others the root of the gain.
  enum Row { kLength, kFactor, kNumRows };
  size_t stride = 0;  // antennas of the end that has more of them
  NodeRows rows;      // of leg * stride + antenna
};
ChainLegs measure_legs(const ChainPlan& plan, const PosedPoints& points, const AntennaImages& transmitters,
                       const AntennaImages& receivers);

// Inner parts (DiffuseInner); rows by node.
struct ChainInner {
  enum Row { kLength, kToFirst, kRootCosFirst, kFactor, kFirstSign, kLastSign, kNumRows };
  std::vector<uint8_t> begins_specular, is_single;  // [inner]
  NodeRows rows;
};
ChainInner measure_inner(const ChainPlan& plan, const PosedPoints& points);

}  // namespace echopath
