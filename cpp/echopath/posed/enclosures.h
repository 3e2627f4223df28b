#pragma once
// Finds bodies in which antennas stand.
#include <vector>

#include "echopath/posed/bodies.h"
#include "echopath/radar/radar.h"

namespace echopath {

// Describes a body without openings in which an antenna stands while something stands outside of it, which is not seen.
struct Enclosure {
  int node = 0;               // index into Scene::nodes(), of a child of the root or of one mesh below it
  bool of_receivers = false;  // the antenna is the first of the receivers, else of the transmitters
};

// Returns the bodies, as `pose` has them, that hold the first transmitter or the first receiver then; of a body that does
// not as a whole, the mesh that does, such as the cupboard of a room that is one body. Seen from a point inside, a closed
// surface fills the sphere: the solid angles of its triangles add up to 4 pi. Sheets, through which waves pass, are
// openings. What is wound against its neighbours, and shells whose inner side is wound against the outer one, add up to
// less and are not found; a hole of less than a hundredth of the sphere (20 by 20 degrees) is no opening. Raises
// invalid_argument where a motion is not defined then.
std::vector<Enclosure> enclosures(const Scene& scene, const PosedScene& pose, const std::vector<Body>& bodies,
                                  const Radar& radar);

}  // namespace echopath
