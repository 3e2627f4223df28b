#pragma once
// Estimates without rays what sharp edges carry, to tell whether a trace should look for them and which of them matter.
#include <limits>
#include <span>
#include <vector>

#include "echopath/posed/posed_antenna.h"
#include "echopath/radar/radar.h"
#include "echopath/record/posed_edge.h"
#include "echopath/scene/scene.h"

namespace echopath {

// Describes the unfolded leg between an antenna and a point of an edge.
struct EdgeLeg {
  Vec3 to_antenna, at_antenna;  // unit: from the point toward the antenna or its image, and of departure from the antenna
  double length;                // m
};

class EdgeEstimate {
 public:
  // Positions count from `origin` (m, world). The radar must outlive it.
  EdgeEstimate(const Radar& radar, const Transform& world_from_radar, const Vec3& origin);
  // Returns the power in W of the first-order field of an edge between the pair of antennas that it couples most: that about
  // the point nearest to the radar, over what keeps the phase there, were nothing in the way.
  double power(const PosedEdge& edge, const Material& material) const;
  // Returns the power in W at the best pair of antennas of an edge whose matrix (edge_diffraction.h) has the norm `coupled`,
  // over as much of it as keeps the phase, and at most `longest` (m). Edges that follow each other along a curve send no
  // more than one such edge that is not cut off.
  double power(const Wedge& wedge, const EdgeLeg& in, const EdgeLeg& out, double coupled,
               double longest = std::numeric_limits<double>::infinity()) const;

 private:
  double frequency_, wavenumber_, transmit_power_;  // Hz, rad/m, W
  std::vector<PosedAntenna> transmitters_, receivers_;
};

// Returns the power in W that the strongest of some edges of a scene carries by itself; 0 where none is in the pattern. It
// misses echoes over mirrors.
double strongest_of(std::span<const PosedEdge> edges, const Scene& scene, const EdgeEstimate& estimate);
// Returns the same of all edges of a scene at a time (s). Raises invalid_argument when a motion is not defined then.
double strongest_edge(const Scene& scene, const Radar& radar, double time);

// Returns the power in W below which a trace leaves out an edge's echo: 40 dB below the noise of a cell where the strongest
// edge stands out of that, else 0.
double least_edge_power(double strongest, const Radar& radar);

}  // namespace echopath
