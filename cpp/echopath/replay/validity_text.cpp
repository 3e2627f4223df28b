#include <algorithm>
#include <cmath>
#include <sstream>

#include "echopath/replay/validity.h"

namespace echopath {
namespace {

constexpr size_t kMaxObjects = 3;    // in the text
constexpr size_t kValueColumn = 37;  // of the text

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
  const std::string found = percent(report.shares.slid) + " of the power is off by more than " + radians(kPhaseLimit) +
                            " of phase (at most " + radians(report.largest_phase_error) + "): its points of reflection slide. ";
  const bool helps = report.specular == SpecularPoints::kMaterial && report.stepped_phase_error < 0.5 * report.largest_phase_error;
  const std::string step = "replay=\"fermat\" leaves at most " + radians(report.stepped_phase_error) + "; or trace ";
  const std::string advice = found + (helps ? step : "Trace ");
  if (report.motion_phase_error <= kPhaseLimit) return advice + "parts of the array by themselves: it is too wide for one trace.";
  return advice + "each of " + std::to_string(report.keyframes()) + " parts of the frame by itself.";
}

// What of an object is affected by more than the limit.
std::string concerns(const ValidityShares& shares) {
  std::string text;
  const auto add = [&](const char* name, double share) {
    if (share > kValidityLimit) text += (text.empty() ? "" : ", ") + std::string(name) + " " + percent(share);
  };
  add("slid", shares.slid);
  add("left", shares.left);
  add("blocked", shares.blocked);
  add("turned", shares.turned);
  add("new surface", shares.new_surface);
  return text;
}

std::string line(const std::string& label, const std::string& value) {
  std::string text = "\n  " + label;
  text.resize(std::max(text.size() + 1, kValueColumn), ' ');
  return text + value;
}

// Objects of which more than the limit is affected although the whole may hold.
std::string object_lines(const Validity& report) {
  std::string text;
  size_t count = 0;
  for (const ObjectValidity& object : report.objects) {
    const std::string found = concerns(object.shares);
    if (!found.empty() && ++count <= kMaxObjects) text += line("of '" + object.name + "' alone", found);
  }
  if (count > kMaxObjects) text += line("and of", std::to_string(count - kMaxObjects) + " more objects");
  return text;
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
  const std::vector<std::string> found = warnings();
  std::string text = found.empty() ? "one trace serves this frame" : "one trace does not serve this frame";
  if (has_array) text += " and this array";
  for (const std::string& warning : found) text += "\n* " + warning;
  const std::string sizes = radians(rms_phase_error) + " rms, " + radians(largest_phase_error) + " at most";
  text += line(specular == SpecularPoints::kMaterial ? "reflection slides" : "slides, one Newton step", sizes + ", more than " + radians(kPhaseLimit) + " for " + percent(shares.slid) + " of the power");
  text += line("reflection leaves its surface", percent(shares.left));
  text += line("something comes in the way", percent(shares.blocked));
  text += line("surfaces turn", percent(shares.turned));
  text += line("surface that was hidden", percent(shares.new_surface));
  return text + object_lines(*this);
}

}  // namespace echopath
