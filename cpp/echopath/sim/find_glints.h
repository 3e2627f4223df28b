#pragma once
// Points of reflection that the rays of a trace may be too far apart for.
#include <string>
#include <vector>

#include "echopath/base/job.h"
#include "echopath/trace/paths.h"

namespace echopath {

// A direction of launch about which the length of a way is stationary.
struct Glint {
  std::string of;         // name of the stratum (of a focus, of the one that it is in)
  Vec3 direction;         // unit, world axes
  double power = 0.0;     // W, by stationary phase
  double narrow = 0.0, wide = 0.0;  // rad: within so much of it, across and along, the phase turns by half a cycle
  double cell = 0.0;      // rad, side of the launch cells of the trace there
};

// Of the ways of one bounce and any number of flagged mirrors before and behind it that coherent paths of the record take: all
// points of their meshes where the way's length is stationary (reflection_point.h) and beside which there is such a path, so that
// it is seen. Facets of a curved body count as the curved surface that they stand for. Strongest first, one for each
// point. Raises Cancelled.
std::vector<Glint> find_glints(const Paths& paths, Job* job = nullptr);

}  // namespace echopath
