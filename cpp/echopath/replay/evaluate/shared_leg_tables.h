#pragma once
// Holds everything that the paths of a block share, at all nodes: posed points, images of antennas, legs, inner parts.
// Tables keep their memory from block to block.
#include <deque>

#include "echopath/replay/evaluate/shared_leg_plan.h"
#include "echopath/replay/posed/posed_nodes.h"

namespace echopath {

// Holds the distinct points of a block.
struct PosedPoints {
  // Describes a point as it was at the trace.
  struct Traced {
    Vec3 position, normal;  // m, relative to the origin; unit
    const Mat3* curvature;  // PosedHit::curvature; null where the surface is flat or may stretch
  };
  NodeRows rows;               // PointToPose::Row
  std::vector<Traced> traced;  // [point]
  std::deque<std::array<Vec3, 3>> normals;
  std::deque<Mat3> curvatures;

  PosedHit at(size_t point, size_t node) const;
  PosedHit at_trace(size_t point) const;
  void find(const SharedLegPlan& plan, const PathPreparer& preparer, const PosedNodes& nodes);

 private:
  void pose_rigid(const LocalHit& hit, const PathPreparer& preparer, const PosedNodes& nodes, size_t point);
  void pose_stretched(const LocalHit& hit, const PathPreparer& preparer, const PosedNodes& nodes, size_t point);
};

// Holds the antennas of one end and their images in mirrors: a leg is a straight line from one of them.
struct AntennaImages {
  size_t num_antennas = 0;
  std::vector<const AntennaPattern*> pattern;  // [antenna]
  NodeRows rows;                               // of image * num_antennas + antenna, LegToMeasure::ImageRow
  // Turns directions from the frame of the image into the axes of the antenna, [image, antenna, node]; it is empty where no
  // pattern needs it.
  std::vector<Mat3> antenna_from_image;

  // `mirrors` has rows [normal x, y, z, offset] of the planes normal.x = offset, in m.
  void find(const SharedLegPlan& plan, const NodeRows& mirrors, const PosedNodes& nodes, bool of_receivers);
  size_t entry(uint32_t image, size_t antenna) const { return image * num_antennas + antenna; }
  // Measures the leg from an entry to a point (PointToPose::Row) and writes LegToMeasure::Row to `out`. `phase` is a row for
  // the phase of the antenna in rad, or null.
  void measure(size_t entry, const double* point, double* out, double* phase) const;

 private:
  void finish(size_t entry, const double* point, double* out, double* phase) const;
};

// Returns where the mean antenna of an end was at the trace, in m relative to the origin of posed scenes.
Vec3 mean_antenna_at_trace(const Paths& paths, bool of_receivers);

// Maps an antenna to an image of it, as the mirrors stood at the trace.
struct ImageAtTrace {
  Mat3 linear = Mat3::Identity();
  Vec3 translation = Vec3::Zero();  // m

  Vec3 of(const Vec3& antenna) const { return linear * antenna + translation; }
  // Returns the axes at the antenna across the line from its image to a point.
  AxesAcross<double> axes_toward(const Vec3& point, const Vec3& antenna) const;
};
std::vector<ImageAtTrace> images_at_trace(const SharedLegPlan& plan, const PathPreparer& preparer);

// Holds the legs from images of antennas to points.
struct LegTable {
  NodeRows rows;        // [leg], LegToMeasure::Row
  NodeRows phases;      // [leg], one row: phase of the antenna, rad; empty where no antenna has one
  NodeRows components;  // [leg], ComponentsToFind::Row; empty where polarisations are not asked for
  bool has_phases = false, has_components = false;

  void resize(size_t num_legs, size_t num_nodes, bool with_phases, bool with_components);
  size_t num_bytes() const { return rows.num_bytes() + phases.num_bytes() + components.num_bytes(); }
};

// Holds the inner parts of the paths (DiffuseInner).
struct InnerPartTable {
  std::vector<uint8_t> begins_specular, is_single;  // [inner]
  NodeRows rows;                                    // InnerRows::Row

  void find(const SharedLegPlan& plan, const PosedPoints& points);
};

// Holds the parts of paths with sliding points of reflection (specular_slide.h). These points depend on the antenna at which
// the path begins, so entries are counted by slide * SharedLegTables::stride + antenna.
struct SlidingParts {
  NodeRows points;  // the first material point, PointToPose::Row
  LegTable legs;    // from the antenna to it
  NodeRows inner;   // InnerRows::Row

  // Finds all but the legs.
  void find(const SharedLegPlan& plan, const PathPreparer& preparer, const PosedNodes& nodes, size_t stride);

 private:
  void move_points(const LocalPath& path, size_t first_entry, const PosedNodes& nodes);
};

// Returns the exponent of a gain where it is a whole number that the kernels can evaluate, else LegToMeasure::kNoExponent.
int exponent_of(const AntennaPattern& pattern);

// Returns an inner part as a path of its own, over the hits of `plan.inner_points`.
LocalPath path_of(const SharedLegPlan::Inner& inner);

struct SharedLegTables {
  PosedPoints points;
  NodeRows mirrors;
  AntennaImages images[2];                   // of transmitters, of receivers
  NodeRows axes;                             // [image], ComponentsToFind::AxisRow, where polarisations are asked for
  std::vector<ImageAtTrace> traced_images;   // [image], likewise
  std::vector<AxesAcross<double>> leg_axes;  // [leg] those of the matrices of its paths, where legs have components
  size_t stride = 0;                         // number of antennas of the end that has more
  LegTable legs;                             // of leg * stride + antenna
  InnerPartTable inner;
  SlidingParts sliding;
  bool has_phases = false, has_polarizations = false;

  void find(const SharedLegPlan& plan, const PathPreparer& preparer, const PosedNodes& nodes);
  // Measures the leg from an image of an antenna to a point (PointToPose::Row). Where it has components, `recorded` are the
  // axes of the matrix.
  struct ImageOfAntenna {
    bool of_receivers;
    uint32_t image;
    size_t antenna;
    const AxesAcross<double>* recorded;
  };
  void measure(const ImageOfAntenna& from, const double* point, const PosedNodes& nodes, size_t leg, LegTable& to) const;
  // Returns whether polarisations must be evaluated at all nodes, because they differ from path to path or from node to node
  // (PosedNodes::is_upright).
  static bool needs_polarizations(const Paths& paths, const PosedNodes& nodes) {
    return !paths.jones.empty() && !nodes.is_upright;
  }
  size_t num_bytes() const;  // of what is kept for the next block

 private:
  void find_leg_axes(const SharedLegPlan& plan, const Paths& paths);
  const AxesAcross<double>* axes_of(uint32_t leg) const { return has_polarizations ? &leg_axes[leg] : nullptr; }
  void measure_legs(const SharedLegPlan& plan, const PosedNodes& nodes);
};

}  // namespace echopath
