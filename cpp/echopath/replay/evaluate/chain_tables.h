#pragma once
// Everything that the paths of a block share, at all nodes: posed points, images of antennas, legs, inner parts. Tables keep their
// memory from block to block.
#include <deque>
#include <span>

#include "echopath/replay/evaluate/chain_plan.h"
#include "echopath/replay/posed/node_poses.h"

namespace echopath {

// A level as the tables see it.
struct LevelView {
  std::span<const Instant> instants;
  const NodePoses& poses;
};

// Distinct points of a block.
struct PosedPoints {
  // At the trace.
  struct Traced {
    Vec3 position, normal;        // m, relative to the origin; unit
    const Mat3* curvature;        // PosedHit::curvature; null where the surface is flat or may stretch
  };
  NodeRows rows;                  // PointToPose::Row
  std::vector<Traced> traced;     // [point]
  std::deque<std::array<Vec3, 3>> normals;
  std::deque<Mat3> curvatures;

  PosedHit at(size_t point, size_t node) const;
  PosedHit at_trace(size_t point) const;
  void find(const ChainPlan& plan, const Localiser& localise, const LevelView& level);

 private:
  void pose_rigid(const LocalHit& hit, const Localiser& localise, const LevelView& level, size_t point);
  void pose_stretched(const LocalHit& hit, const Localiser& localise, const LevelView& level, size_t point);
};

// Antennas of one end as they are seen over mirrors: a leg is a straight line from one of them.
struct AntennaImages {
  bool of_receivers = false;
  size_t num_antennas = 0;
  std::vector<const AntennaPattern*> pattern;  // [antenna]
  NodeRows rows;                               // of image * num_antennas + antenna, LegToMeasure::ImageRow
  // Directions toward the image -> axes of the antenna, [image, antenna, node]; empty where no pattern needs it.
  std::vector<Mat3> antenna_from_image;

  // mirrors: rows [normal x, y, z, offset] of the planes normal.x = offset, m.
  void find(const ChainPlan& plan, const NodeRows& mirrors, const LevelView& level, bool of_receivers);
  size_t entry(uint32_t image, size_t antenna) const { return image * num_antennas + antenna; }
  // From an entry to a point (PointToPose::Row), as LegToMeasure::Row; phase: a row for that of the antenna, rad, or null.
  void measure(size_t entry, const double* point, double* out, double* phase) const;

 private:
  void finish(size_t entry, const double* point, double* out, double* phase) const;
};

// Polarisations across the legs, where polarised paths ask for them.
struct LegPolarizations {
  NodeRows axes;  // [image], ComponentsToFind::AxisRow
  NodeRows rows;          // of leg * stride + antenna as in ChainLegs, ComponentsToFind::Row
  NodeRows sliding_rows;  // likewise, of the legs in SlidingParts

  void find_axes(const ChainPlan& plan, const NodeRows& mirrors);
  void find(const ChainPlan& plan, const struct ChainTables& tables, const LevelView& level);  // after the axes
  // Across the leg from an image of an antenna to a point (PointToPose::Row), as ComponentsToFind::Row.
  struct ImageOfAntenna {
    uint32_t image;
    size_t antenna;
  };
  void across(const AntennaImages& images, ImageOfAntenna of, const LevelView& level, const double* point, double* out) const;
};

// All legs of a block, to each antenna of their end.
struct ChainLegs {
  size_t stride = 0;  // antennas of the end that has more of them
  NodeRows rows;      // of leg * stride + antenna, LegToMeasure::Row
  NodeRows phases;    // likewise, one row: of the antenna, rad, where any has one

  void find(const ChainPlan& plan, const PosedPoints& points, const AntennaImages* images, bool with_phase);
};

// Inner parts (DiffuseInner).
struct ChainInner {
  std::vector<uint8_t> begins_specular, is_single;  // [inner]
  NodeRows rows;                                    // InnerRows::Row

  void find(const ChainPlan& plan, const PosedPoints& points);
};

// What sliding points of reflection (specular_slide.h) make of the paths that have them: for each antenna at which a path begins,
// these stand elsewhere.
struct SlidingParts {
  size_t stride = 0;   // antennas of the end that has more of them
  NodeRows points;     // of slide * stride + antenna: the first material point, PointToPose::Row
  NodeRows legs;       // likewise, from the antenna to it: LegToMeasure::Row
  NodeRows phases;     // likewise, one row, as in ChainLegs
  NodeRows inner;      // likewise, InnerRows::Row

  void find(const ChainPlan& plan, const Localiser& localise, const LevelView& level, const AntennaImages* images, bool with_phase);

 private:
  void move_points(const LocalPath& path, size_t slide, const LevelView& level);
};

// Of a gain, where it is a whole one that kernels can do, else LegToMeasure::kNoExponent.
int exponent_of(const AntennaPattern& pattern);

// An inner part as a path of its own, over the hits of `plan.inner_points`.
LocalPath path_of(const ChainPlan::Inner& inner);

struct ChainTables {
  PosedPoints points;
  NodeRows mirrors;
  AntennaImages images[2];  // of transmitters, of receivers
  ChainLegs legs;
  ChainInner inner;
  LegPolarizations polarizations;
  SlidingParts sliding;
  bool has_phase = false, has_polarizations = false;

  void find(const ChainPlan& plan, const Localiser& localise, const LevelView& level);
  // Polarisations differ from path to path or from node to node (NodePoses::is_upright).
  static bool needs_polarizations(const Paths& paths, const LevelView& level) {
    return !paths.jones.empty() && !level.poses.is_upright;
  }
  size_t num_bytes() const;  // of what is kept for the next block
};

}  // namespace echopath
