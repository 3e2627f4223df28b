#pragma once
// Finds by shadow rays which objects a radar can see: the share of each that nothing else hides.
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "echopath/base/threads/job.h"
#include "echopath/label/objects/surfaces.h"
#include "echopath/radar/radar.h"

namespace echopath {

class KeptGeometry;  // trace/embree/kept_geometry.h

// Describes an object as one end of the radar sees it, from the mean position of its antennas.
struct VisibilityFromEnd {
  double solid_angle = 0.0;    // sr that the object would fill alone; 0: no ray found it (edge-on)
  double visible_share = 0.0;  // share of it that nothing else hides; an object does not hide itself
  // These are the surfaces that hide the object, by name, with their shares of its solid angle, largest first. With
  // visible_share they add up to 1.
  std::vector<std::pair<std::string, double>> occluders;
  double distance = 0.0;  // m, to the nearest point of its triangles
  // Tells whether an antenna has gain toward a part of the object, hidden or not, or toward one of its vertices where no ray
  // met the object.
  bool in_view = false;
};

struct ObjectVisibility {
  std::string name;
  std::vector<uint32_t> mesh_ids;
  VisibilityFromEnd transmitter, receiver;
};

// Ends that are so near each other that the outline of an object moves by a twentieth of its width at most share the outline
// that the transmitter sees; what hides it they look for each for itself.
struct VisibilitySettings {
  double time = 0.0;  // s
  // This is about the number of directions on each object, as if all were looked at, of a grid over the stratum that holds
  // the object (visibility_grid.h). The grid has up to 16 times as many cells where the object fills little of the stratum.
  // The error of a share is 4e-4 rms for half hidden plates and 4096 directions, and falls with the power -0.75; of people,
  // cars and poles that hide each other it is 8e-3 rms and 3e-2 at most with 128, 4e-3 and 2e-2 with 512, 7e-4 and 3e-3 with
  // 4096 (238 in eight scenes at random). What hides less than a block of the grid, 1/500 of the stratum with 4096, and
  // nothing beside it, may be missed. Of 512 cells or fewer, all are looked at; of more, 512 or more first
  // (visibility_grid.h). An object that one surface hides in all of the first directions, 256 of them on it at least, is
  // hidden: then its solid angle is that of these alone.
  int num_directions = 4096;
};

// Computes the visibility of the objects of `surfaces`, in order, with the same bits for any number of threads. With `kept`,
// it uses the geometry that a trace of the scene left there, and leaves its own. Raises invalid_argument for num_directions
// below 1, a bad radar or motions that do not cover the time; raises Cancelled.
std::vector<ObjectVisibility> visibility(const Scene& scene, const Radar& radar, const SurfaceMap& surfaces,
                                         const VisibilitySettings& settings = {}, Job* job = nullptr,
                                         KeptGeometry* kept = nullptr);

}  // namespace echopath
