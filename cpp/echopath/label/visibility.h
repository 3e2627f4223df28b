#pragma once
// Which objects a radar can see: the share of each that nothing else hides, by shadow rays.
#include <string>
#include <utility>
#include <vector>

#include "echopath/base/job.h"
#include "echopath/label/surfaces.h"
#include "echopath/radar/radar.h"

namespace echopath {

// An object as one end of the radar sees it, from the mean position of its antennas.
struct Sight {
  double solid_angle = 0.0;    // sr that the object would fill alone; 0: no direction found it (seen edge-on)
  double visible_share = 0.0;  // of it, where nothing else is nearer; an object does not hide itself
  // What is nearest elsewhere, by name, and its share of the solid angle; largest first. With visible_share they add to 1.
  std::vector<std::pair<std::string, double>> occluders;
  double distance = 0.0;       // m, to the nearest point of its triangles
  // An antenna has gain toward a part of it, hidden or not; toward a vertex of it where no direction found it.
  bool in_view = false;
};

struct ObjectVisibility {
  std::string name;
  Sight transmitter, receiver;
};

struct VisibilitySettings {
  double time = 0.0;          // s
  // Directions on each object, about: a lattice over the cone that holds it, refined (at most kFinestLattice times) where
  // the object fills little of that. The error of a share is 4e-4 rms for half hidden plates and 4096 directions, and
  // falls with the power -0.8.
  int num_directions = 4096;
};
inline constexpr int kFinestLattice = 16;

// Of the objects of `surfaces`, in order. The same bits for any number of threads. Raises invalid_argument for
// num_directions below 1, a bad radar or motions that do not cover the time; Cancelled.
std::vector<ObjectVisibility> visibility(const Scene& scene, const Radar& radar, const SurfaceMap& surfaces,
                                         const VisibilitySettings& settings = {}, Job* job = nullptr);

}  // namespace echopath
