#pragma once
// Describes the part of a path between its first and its last material point; it is the same for all antennas.
#include "echopath/replay/posed/path_geometry.h"

namespace echopath {

struct InnerPart {
  double length = 0.0;            // m
  double to_first_diffuse = 0.0;  // m, from the first material point
  double power_factor = 1.0;      // product of f cos_out cos_in / r^2 of the legs between diffuse hits
  Vec3 last_arrival;              // at the last material point, if it is not the first
  int first_diffuse = -1;
  double cos_in_first = 0.0;   // signed, at the first diffuse hit, if it is not the first material point
  double cos_out_first = 0.0;  // signed, if it is not the last
  double cos_in_last = 0.0;    // signed, at the last diffuse hit, if it is not the first one
  bool is_lit = true;          // each diffuse hit between two others sends on from the side where the wave arrives
};

// Reads only the events and material points of the path, and only points and normals of the hits.
InnerPart inner_part(const LocalPath& path, const PosedHit* hits);

// Holds the values of an inner part that a diffuse path needs (path_formula.h).
struct DiffuseInner {
  bool begins_specular = false;  // the first material point is none of the diffuse hits
  bool is_single = true;         // there is one diffuse hit
  double to_first = 0.0;         // m, from the first material point to the first diffuse hit
  double root_cos_first = 0.0;   // sqrt|cos_in| at the first diffuse hit with the sign of cos_in, where it begins_specular
  double factor = 1.0;
  double first_sign = 1.0, last_sign = 1.0;  // of cos_out at the first, of cos_in at the last diffuse hit of several
};
DiffuseInner diffuse_inner(const LocalPath& path, const PosedHit* hits, const InnerPart& inner);

}  // namespace echopath
