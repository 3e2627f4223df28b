#pragma once
// Describes a launch stratum: a part of the directions about the transmitter, with rays spread evenly over it.
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "echopath/base/geometry.h"

namespace echopath {

// A stratum is a cone about an axis, or a strip along a great circle (half_azimuth > 0). A strip holds long things, because
// straight lines seen from a point lie along great circles. Both are mapped with equal areas
// (trace/launch/launch_directions.h).
struct Stratum {
  Vec3 axis = Vec3::UnitX();     // unit, world axes; of a strip, the middle of the great circle
  double versine = 2.0;          // cone: 1 - cos(half angle), exact for narrow cones; 2: whole sphere
  Vec3 across = Vec3::Zero();    // strip: unit, at right angles to the axis, along the great circle
  double half_azimuth = 0.0;     // strip: rad, along the great circle on both sides of the axis
  double low = 0.0, high = 0.0;  // strip: sine of the elevation over the great circle, toward axis x across
  int64_t num_rays = 0;
  double ray_density = 0.0;  // rays per sr inside, N_k p_k; exact, so that its integral may differ from num_rays
  std::string name;          // what it aims at
  int object = -1;           // node of the scene that it aims at; -1: none
  int num_mirrors = 0;       // over which it aims there
  int focus_of = -1;         // index of the stratum in which it is a focus (trace/launch/launch_focus.h); -1: none

  bool is_strip() const { return half_azimuth > 0.0; }
  bool is_focus() const { return focus_of >= 0; }
  double solid_angle() const;                  // sr
  bool contains(const Vec3& direction) const;  // unit direction
  bool operator==(const Stratum&) const = default;
};

// These convert the half angle of a cone in rad to 1 - cos and back, without cancellation for narrow cones.
double versine_of(double half_angle);
double half_angle_of(double versine);

// Holds shares of the rays relative to each other, by the name of a stratum; strata that are not named get the mean.
using RayShares = std::map<std::string, double>;
// Returns the shares of a plan that was carried out; the rays of foci count for the strata that they are in.
RayShares shares_of(const std::vector<Stratum>& strata);

}  // namespace echopath
