#pragma once
// The certificate of a replay: for what share of the power does one trace not serve the whole frame and the whole array?
#include <cstdint>
#include <string>
#include <vector>

#include "echopath/base/job.h"
#include "echopath/replay/specular_slide.h"
#include "echopath/trace/paths.h"

namespace echopath {

struct ValiditySettings {
  std::vector<double> times;  // s, at which paths are checked; empty: at the centres of the first and the last chirp
  bool arrays = false;        // keep what is found of each path
  SpecularPoints specular = SpecularPoints::kMaterial;  // of the replay that is to be certified
};

// Shares of the power that the replay carries, of a set of paths. The power of a path is the mean of |a|^2 between the first
// antennas over the trace time and the times of the check. Those of physical-optics paths, which add up as fields, are scaled
// in common to the power of their sum, averaged over the band: else their share would depend on the number of rays.
struct ValidityShares {
  double power = 0.0;        // W, what the shares are of
  double slid = 0.0;         // phase error of points of reflection above kPhaseLimit
  double left = 0.0;         // points of reflection that leave the surface around their hit
  double blocked = 0.0;      // something comes in the way of a leg
  double turned = 0.0;       // a cosine of incidence or departure changes its sign or by more than a factor of two
  double new_surface = 0.0;  // of the power of single echoes of all that is seen: of what was hidden from the trace
};

inline constexpr double kPhaseLimit = 0.3;       // rad
inline constexpr double kValidityLimit = 0.01;   // share of the power above which a warning is due

// [P] each, hits in the order of the record; empty unless asked for.
struct ValidityArrays {
  std::vector<double> power;               // W
  std::vector<float> phase_error;          // rad, largest over times and antennas where no point of reflection has left
  std::vector<float> stepped_phase_error;  // rad, what a Newton step to the moved points of reflection leaves
  std::vector<uint64_t> left;              // bit k: the point of reflection of hit k leaves its surface
  std::vector<uint64_t> blocked;           // bit k: something comes in the way of the leg that arrives at hit k
  std::vector<uint8_t> receiver_blocked;   // 1: of the leg to the receiver
  std::vector<uint8_t> turned;             // 1: see ValidityShares
  std::vector<float> cosine_change;
};

struct ObjectValidity {
  std::string name;
  ValidityShares shares;  // of the paths whose last hit that is no image lies on the object; of all of it that is seen
};

struct Validity {
  int64_t num_paths = 0;
  std::vector<double> times;          // s, of the check
  bool has_array = false;             // some antenna stands elsewhere than those of the trace
  SpecularPoints specular = SpecularPoints::kMaterial;
  ValidityShares shares;
  // rad: weighted by power, and largest over the paths that carry any; the largest by motion alone (for the trace's own
  // antennas), and the largest that a Newton step leaves.
  double rms_phase_error = 0.0, largest_phase_error = 0.0, motion_phase_error = 0.0, stepped_phase_error = 0.0;
  double largest_cosine_change = 0.0;
  std::vector<ObjectValidity> objects;  // by strength
  ValidityArrays arrays;

  // Traces over a frame, each for its own part, that bring the phase error of motion below kPhaseLimit: it falls with the
  // square of the time from the trace.
  int keyframes() const;
  // What does not hold and what to do about it, a sentence each; empty where one trace serves.
  std::vector<std::string> warnings() const;
  std::string text() const;
};

// Checks paths at the given times (by default the ends of the frame) for the trace's own antennas and those at the rim of the
// array of `radar`: the error of the length by points of reflection that slide (specular_slide.h; images are exact), whether
// they still lie on their surface, shadow rays of all legs, cosines; and, with rays of its own, surface that was hidden from the
// trace. Memory does not grow with the paths unless `arrays` is set. The same bits for any number of threads. Raises
// invalid_argument for a bad radar, motions that do not cover the times or the frame, Cancelled.
Validity validity(const Paths& paths, const Radar& radar, const ValiditySettings& settings = {}, Job* job = nullptr);

}  // namespace echopath
