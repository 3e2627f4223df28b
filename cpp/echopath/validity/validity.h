#pragma once
// Certifies a replay: for what share of the power does one trace not serve the whole frame and the whole array?
#include <cstdint>
#include <string>
#include <vector>

#include "echopath/base/threads/job.h"
#include "echopath/record/paths.h"
#include "echopath/replay/posed/specular_slide.h"

namespace echopath {

struct ValiditySettings {
  std::vector<double> times;                            // s, at which paths are checked; empty: those of check_times.h
  bool arrays = false;                                  // keep what is found of each path
  SpecularPoints specular = SpecularPoints::kMaterial;  // of the replay that is to be certified
};

// Holds shares of the power that the replay of a set of paths carries. The power of a path is the mean of |a|^2 between the
// first antennas over the trace time and the times of the check. The powers of physical-optics paths, which add up as
// fields, are scaled in common to the power of their sum, averaged over the band: else their share would depend on the
// number of rays.
struct ValidityShares {
  double power = 0.0;         // W, the whole of the shares
  double slid = 0.0;          // phase error of points of reflection above kPhaseLimit
  double left = 0.0;          // points of reflection that leave the surface around their hit
  double blocked = 0.0;       // something comes in the way of a leg
  double turned = 0.0;        // a cosine of incidence or departure changes its sign or by more than a factor of two, or an
                              // image's coefficient of reflection by more than kEdgeLimit
  double beside_edges = 0.0;  // what edges of planes leave of images over them changes by more than kEdgeLimit
  double new_surface = 0.0;   // of what is seen at the times of the check: power from surface that was hidden from the trace
};

inline constexpr double kPhaseLimit = 0.3;       // rad
inline constexpr double kEdgeLimit = 0.3;        // of a field, which changes by as much with kPhaseLimit
inline constexpr double kValidityLimit = 0.01;   // share of the power above which a warning is due
inline constexpr double kObjectLimit = 0.05;     // the same for the power of an object
inline constexpr double kObjectErrorDb = 0.5;    // dB, the same for the error of an object's power over the frame
inline constexpr double kDynamicRangeDb = 60.0;  // objects this far below the strongest need not be right
inline constexpr int kOcclusionKeyframes = 16;   // where echoes come, go or change their strength
inline constexpr int kMaxKeyframes = 1000000;    // most that are advised; no frame has as many chirps
inline constexpr double kKeyframeTurn = 0.2;     // rad: how far what changes so may turn from keyframe to keyframe

// Holds what was found of each path, [P] each, with hits in the order of the record; empty unless asked for.
struct ValidityArrays {
  std::vector<double> power;               // W
  std::vector<float> phase_error;          // rad, largest over times and antennas where no point of reflection has left
  std::vector<float> stepped_phase_error;  // rad, what a Newton step to the moved points of reflection leaves
  std::vector<uint64_t> left;              // bit k: the point of reflection of hit k leaves its surface
  std::vector<uint64_t> blocked;           // bit k: something comes in the way of the leg that arrives at hit k
  std::vector<uint8_t> receiver_blocked;   // 1: something comes in the way of the leg to the receiver
  std::vector<uint8_t> turned;             // 1: see ValidityShares
  std::vector<float> cosine_change;
  std::vector<float> edge_change;  // largest of the field that edges of planes leave, over the larger of both
};

// Describes the paths whose last hit that is no image lies on the object, and all of the object that is seen.
struct ObjectValidity : ValidityShares {
  std::string name;
  double disappears = 0.0;  // share of its power that is blocked or lost, mean over the times of the check
  double error_db = 0.0;    // dB, power over the frame: replayed over true, with new surface; 0: not known
  double seen_power = 0.0;  // W, largest power with which the times of the check see it
  double turn = 0.0;        // rad, how far it turns within the frame at most
  bool has_paths = false;
  bool is_in_range = false;  // less than kDynamicRangeDb below the strongest, and above the noise of a range-Doppler cell
  bool is_too_fast = false;  // turns so often that the times of the check may miss something
  bool is_asked = true;      // the record is whole or has paths of it; what a selection leaves out is not missed

  // Returns whether it needs no mending: its paths serve the frame, or it is out of the dynamic range.
  bool ok() const;
};

struct Validity {
  int64_t num_paths = 0;
  std::vector<double> times;       // s, of the check
  double turn_of_radar = 0.0;      // rad, how far the radar turns within the frame at most
  bool is_radar_too_fast = false;  // so often that the times of the check may miss something of any object
  bool has_array = false;          // some antenna stands elsewhere than those of the trace, or has another beam
  bool is_still = false;           // neither the scene nor the radar moves
  SpecularPoints specular = SpecularPoints::kMaterial;
  ValidityShares shares;
  // These are errors of phase in rad: the rms weighted by power; the largest over the paths that carry any power; the
  // largest by motion alone (for the trace's own antennas); and the largest that a Newton step leaves.
  double rms_phase_error = 0.0, largest_phase_error = 0.0, motion_phase_error = 0.0, stepped_phase_error = 0.0;
  double largest_cosine_change = 0.0;
  // These are the largest change of what edges of planes leave of a field (ValidityArrays::edge_change), over the paths that
  // carry any power, and the largest way in half Fresnel zones of a point of reflection by which it changes too much.
  double largest_edge_change = 0.0, edge_slide = 0.0;
  std::vector<ObjectValidity> objects;  // by strength
  double cell_noise = 0.0;              // W at the antenna, of an echo as strong as the noise of a range-Doppler cell
  ValidityArrays arrays;

  // Returns how many traces, each for its own part of the frame, serve it. The phase error of motion, which falls with the
  // square of the time from the trace, is then below kPhaseLimit, the change of what edges leave is below kEdgeLimit, and
  // what changes turns by kKeyframeTurn at most. There are at least kOcclusionKeyframes where something is blocked, comes
  // into view, leaves its surface or turns, and for objects whose power is off. What stands still needs no further ones.
  int keyframes() const;
  bool shares_hold() const;  // each share of the whole is below kValidityLimit
  // Returns what does not hold and what to do about it, a sentence each; empty where one trace serves.
  std::vector<std::string> warnings() const;
  std::string text() const;
};

// Checks paths at the times of check_times.h, or at those given, for the trace's own antennas and those at the rim of the
// array of `radar`. It finds the error of the length by points of reflection that slide (specular_slide.h; images are
// exact), whether they still lie on their surface, which legs are blocked (by shadow rays), how cosines change and what
// edges of planes leave of images over them, and, with rays of its own, surface that was hidden from the trace. Of paths
// that end in a rough surface it checks at most kPathsChecked of each object and number of bounces, evenly spread over the
// record; with `arrays` it checks all. Memory grows with those alone. The result has the same bits for any number of
// threads. Raises invalid_argument for a bad radar and for motions that do not cover the times or the frame; raises
// Cancelled.
inline constexpr int64_t kPathsChecked = 1 << 14;
Validity validity(const Paths& paths, const Radar& radar, const ValiditySettings& settings, Job* job);

}  // namespace echopath
