#include <algorithm>
#include <cmath>
#include <sstream>

#include "echopath/replay/validity.h"

namespace echopath {
namespace {

constexpr size_t kMaxObjects = 3;  // in the text

std::string percent(double share) {
  std::ostringstream text;
  text.precision(share < 0.1 ? 2 : 3);
  text << 100.0 * share << " %";
  return text.str();
}

std::string radians(double phase) {
  std::ostringstream text;
  text.precision(2);
  text << phase << " rad";
  return text.str();
}

const char* where(const Validity& report) {
  return report.has_array ? "at an end of the frame or the rim of the array" : "at an end of the frame";
}

std::string slide_warning(const Validity& report) {
  std::string text = percent(report.shares.slid) + " of the power is off by more than " + radians(kPhaseLimit) +
                     " of phase (at most " + radians(report.largest_phase_error) + "): its points of reflection slide. ";
  if (report.motion_phase_error > kPhaseLimit) {
    text += "Trace each of " + std::to_string(report.keyframes()) + " parts of the frame by itself.";
  } else {
    text += "The array is too wide for one trace: trace parts of it by themselves.";
  }
  return text;
}

// Objects of which more than the limit is affected although the whole may hold.
void add_objects(const Validity& report, std::ostringstream& text) {
  size_t count = 0;
  for (const ObjectValidity& object : report.objects) {
    const ValidityShares& s = object.shares;
    if (std::max({s.slid, s.left, s.blocked, s.turned, s.new_surface}) <= kValidityLimit) continue;
    if (++count > kMaxObjects) continue;
    text << "\n  of '" << object.name << "': slid " << percent(s.slid) << ", left " << percent(s.left) << ", blocked "
         << percent(s.blocked) << ", turned " << percent(s.turned) << ", new surface " << percent(s.new_surface);
  }
  if (count > kMaxObjects) text << "\n  and " << count - kMaxObjects << " more objects";
}

}  // namespace

int Validity::keyframes() const { return std::max(1, static_cast<int>(std::ceil(std::sqrt(motion_phase_error / kPhaseLimit)))); }

std::vector<std::string> Validity::warnings() const {
  std::vector<std::string> out;
  if (shares.slid > kValidityLimit) out.push_back(slide_warning(*this));
  if (shares.left > kValidityLimit) {
    out.push_back(percent(shares.left) + " of the power is reflected at points that leave the surface around them " +
                  where(*this) + ", over an edge or a crease. Trace shorter frames.");
  }
  if (shares.blocked > kValidityLimit) {
    out.push_back("Something comes in the way of " + percent(shares.blocked) + " of the power " + where(*this) +
                  ". Trace shorter frames.");
  }
  if (shares.turned > kValidityLimit) {
    out.push_back(percent(shares.turned) + " of the power comes from surfaces that turn to or away from the rays within "
                  "the frame. Trace shorter frames.");
  }
  if (shares.new_surface > kValidityLimit) {
    out.push_back(percent(shares.new_surface) + " of what is seen " + where(*this) +
                  " was hidden from the trace: its echoes are missing. Trace shorter frames.");
  }
  return out;
}

std::string Validity::text() const {
  std::ostringstream text;
  const std::vector<std::string> found = warnings();
  const char* what = has_array ? "this frame and this array" : "this frame";
  text << (found.empty() ? "One trace serves " : "One trace does not serve ") << what << ".";
  for (const std::string& warning : found) text << "\n* " << warning;
  text << "\nphase error of frozen points of reflection: " << radians(rms_phase_error) << " rms, "
       << radians(largest_phase_error) << " at most, above " << radians(kPhaseLimit) << " for " << percent(shares.slid)
       << " of the power\npoints of reflection leave their surface: " << percent(shares.left)
       << "\nlegs blocked: " << percent(shares.blocked) << "\nsurfaces turn: " << percent(shares.turned)
       << ", cosines change by " << largest_cosine_change << " at most\nnew surface: " << percent(shares.new_surface);
  add_objects(*this, text);
  return text.str();
}

}  // namespace echopath
