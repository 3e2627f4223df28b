#pragma once
// What lies between the diffuse hits of a path, as chain_formula.h asks for it.
#include "echopath/replay/amplitude.h"
#include "echopath/replay/chain_formula.h"
#include "echopath/replay/inner_part.h"

namespace echopath {

// What lies between the first and the last material point of a path.
struct DiffuseInner {
  bool begins_specular = false;  // the first material point is none of the diffuse hits
  bool is_single = true;         // there is one diffuse hit
  double to_first = 0.0;         // m, from the first material point to the first diffuse hit
  double root_cos_first = 0.0;   // sqrt|cos_in| at the first diffuse hit with the sign of cos_in, where it begins_specular
  double factor = 1.0;
  double first_sign = 1.0, last_sign = 1.0;  // of cos_out at the first, of cos_in at the last diffuse hit of several
};
DiffuseInner diffuse_inner(const LocalPath& path, const PosedHit* hits, const InnerPart& inner);

// What is the same for all paths, sqrt(W) m.
double diffuse_scale(const RadioConstants& radio);

}  // namespace echopath
