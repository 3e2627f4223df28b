#pragma once
// What lies between the first and the last material point of a path; the same for all antennas.
#include "echopath/replay/path_geometry.h"

namespace echopath {

struct InnerPart {
  double length = 0.0;            // m
  double to_first_diffuse = 0.0;  // m, from the first material point
  double power_factor = 1.0;      // product of f cos_out cos_in / r^2 of the legs between diffuse hits
  Vec3 last_arrival;              // at the last material point, if it is not the first
  int first_diffuse = -1;
  double cos_in_first = 0.0;      // signed, at the first diffuse hit, if it is not the first material point
  double cos_out_first = 0.0;     // signed, if it is not the last
  double cos_in_last = 0.0;       // signed, at the last diffuse hit, if it is not the first one
  bool lit = true;                // every diffuse hit between is seen from one side
};

// Asks of the path for its events and material points alone, and of the hits for points and normals.
InnerPart inner_part(const LocalPath& path, const PosedHit* hits);

}  // namespace echopath
