#include <algorithm>
#include <cmath>
#include <sstream>

#include "echopath/base/constants.h"
#include "echopath/base/text/streamed.h"
#include "echopath/validity/frame/check_times.h"
#include "echopath/validity/validity.h"

namespace echopath {
namespace {

constexpr size_t kMaxObjects = 3;    // in the text
constexpr size_t kValueColumn = 37;  // of the text
constexpr double kNothing = 1e-12;   // share of the power, 120 dB below it, that the text calls 0

// By so much changes what two edges opposite each other leave of a field, per half Fresnel zone, at most.
constexpr double kMostPerHalfZone = 2.0;

std::string percent(double share) {
  return share < kNothing ? "0 %" : with_digits(share < 0.1 ? 2 : 3, 100.0 * share) + " %";
}

std::string radians(double phase) { return with_digits(2, phase) + " rad"; }

std::string dbm(double power) {
  std::ostringstream text;
  text.precision(1);
  text << std::fixed << 10.0 * std::log10(1e3 * power) << " dBm";
  return text.str();
}

const char* where(const Validity& report) {
  return report.has_array ? "within the frame or at the rim of the array" : "within the frame";
}

// Returns " Of 'car' 34 %, of 'van' 10 %." for the objects that the share concerns most.
std::string most_of(const Validity& report, double ValidityShares::* share) {
  std::vector<const ObjectValidity*> found;
  for (const ObjectValidity& object : report.objects) {
    if (object.*share > kValidityLimit && object.is_in_range) found.push_back(&object);
  }
  std::ranges::stable_sort(found, [&](const auto* a, const auto* b) { return a->*share > b->*share; });
  std::string text;
  for (size_t i = 0; i < std::min(found.size(), kMaxObjects); ++i) {
    text += (i == 0 ? " Of '" : ", of '") + found[i]->name + "' " + percent(found[i]->*share);
  }
  return text.empty() ? text : text + ".";
}

std::string parts_of_frame(const Validity& report) {
  const std::string count = std::to_string(report.keyframes());
  return "each of " + count + " parts of the frame by itself (retrace=\"invalid\" or \"always\", keyframes=" + count + ").";
}

// Returns whether what does not hold is due to the array alone.
bool is_by_array(const Validity& report) { return report.has_array && report.is_still; }

constexpr const char* kTooWide = "parts of the array by themselves: it is too wide for one trace.";

std::string less_at_once(const Validity& report) {
  if (is_by_array(report)) return std::string("Trace ") + kTooWide;
  return report.has_array ? "Trace shorter frames, or parts of the array by themselves." : "Trace shorter frames.";
}

std::string slide_warning(const Validity& report) {
  const std::string found = percent(report.shares.slid) + " of the power is off by more than " + radians(kPhaseLimit) +
                            " of phase (at most " + radians(report.largest_phase_error) +
                            "): its points of reflection slide. ";
  const bool helps =
      report.specular == SpecularPoints::kMaterial && report.stepped_phase_error < 0.5 * report.largest_phase_error;
  const std::string step = "replay=\"fermat\" leaves at most " + radians(report.stepped_phase_error) + "; or trace ";
  const std::string lead = found + (helps ? step : "Trace ");
  if (report.motion_phase_error <= kPhaseLimit) return lead + kTooWide;
  return lead + parts_of_frame(report);
}

std::string advice(const Validity& report) {
  if (is_by_array(report)) return std::string("Trace ") + kTooWide;
  return "Trace " + parts_of_frame(report) + (report.has_array ? " What is at rest wants parts of the array instead." : "");
}

std::string missing_warning(const ObjectValidity& object, const Validity& report) {
  const std::string margin = with_digits(2, 10.0 * std::log10(object.seen_power / report.cell_noise));
  return "'" + object.name + "' has no path, but is seen within the frame with up to " + dbm(object.seen_power) + ", " +
         margin + " dB above the noise of a range-Doppler cell: its echoes are missing. " + advice(report);
}

// Of an object or the radar, whose turn within the frame is given in rad.
std::string fast_warning(const std::string& subject, double turn, const Validity& report) {
  if (kChecksPerTurn * turn / kTwoPi < 0.5 * kMaxCheckTimes) {
    return subject + " goes from key to key so often within the frame that " + std::to_string(report.times.size()) +
           " times of the check may miss what becomes of it. Trace shorter frames, or let it move smoothly through its "
           "keys.";
  }
  return subject + " turns up to " + with_digits(3, turn / kTwoPi) +
         " times within the frame, or goes to and fro as often: " + std::to_string(report.times.size()) +
         " times of the check may miss what becomes of it. Trace shorter frames.";
}

// Names what does not hold for an object although the whole does; empty where the warnings of the whole have named it all.
std::string object_concerns(const ObjectValidity& object, const Validity& report) {
  std::string text;
  const auto add = [&](double ValidityShares::* share, const std::string& words) {
    if (object.*share <= kObjectLimit || report.shares.*share > kValidityLimit) return;
    text += (text.empty() ? "" : ", ") + percent(object.*share) + " " + words;
  };
  add(&ValidityShares::new_surface, "of what is seen of it appears");
  add(&ValidityShares::blocked, report.has_array ? "of its power is blocked at some time or for some antennas"
                                                 : "of its power is blocked at some time");
  add(&ValidityShares::left, "leaves its surface");
  add(&ValidityShares::slid, "slides");
  add(&ValidityShares::turned, "turns to or away from the rays");
  add(&ValidityShares::beside_edges, "lies beside edges that come nearer or go farther off");
  return text;
}

std::string object_warning(const ObjectValidity& object, const Validity& report) {
  if (!object.has_paths) return missing_warning(object, report);
  if (object.is_too_fast && !report.is_radar_too_fast) return fast_warning("'" + object.name + "'", object.turn, report);
  std::string concerns = object_concerns(object, report);
  if (std::abs(object.error_db) > kObjectErrorDb && (!concerns.empty() || report.shares_hold())) {
    std::ostringstream error;
    error.precision(2);
    error << std::showpos << object.error_db;
    concerns +=
        (concerns.empty() ? "" : "; ") + std::string("its power over the frame is off by about ") + error.str() + " dB";
  }
  return concerns.empty() ? concerns : "Of '" + object.name + "' " + concerns + ". " + advice(report);
}

// Names the shares that are above the limit.
std::string concerns(const ValidityShares& shares) {
  std::string text;
  const auto add = [&](const char* name, double share) {
    if (share > kValidityLimit) text += (text.empty() ? "" : ", ") + std::string(name) + " " + percent(share);
  };
  add("slid", shares.slid);
  add("left", shares.left);
  add("blocked", shares.blocked);
  add("turned", shares.turned);
  add("beside edges", shares.beside_edges);
  add("new surface", shares.new_surface);
  return text;
}

std::string line(const std::string& label, const std::string& value) {
  std::string text = "\n  " + label;
  text.resize(std::max(text.size() + 1, kValueColumn), ' ');
  return text + value;
}

// Lists the objects of which more than the limit is affected, although the whole may hold.
std::string object_lines(const Validity& report) {
  std::string text;
  size_t count = 0;
  for (const ObjectValidity& object : report.objects) {
    const std::string found = concerns(object);
    if (!found.empty() && ++count <= kMaxObjects) text += line("of '" + object.name + "' alone", found);
  }
  if (count > kMaxObjects) text += "\n  and of " + std::to_string(count - kMaxObjects) + " more";
  return text;
}

// Returns whether the object has other echoes, or echoes of another strength, at other times of the frame.
bool changes(const ObjectValidity& object) {
  const bool is_off = !object.has_paths || std::abs(object.error_db) > kObjectErrorDb;
  return is_off ||
         std::max({object.left, object.blocked, object.turned, object.new_surface, object.disappears}) > kObjectLimit;
}

}  // namespace

int Validity::keyframes() const {
  if (is_still) return 1;  // what an array lacks is the same at all times
  double most = std::max(1.0, std::sqrt(motion_phase_error / kPhaseLimit));
  bool has_new_edges = shares.beside_edges > kValidityLimit;
  if (std::max({shares.left, shares.blocked, shares.turned, shares.new_surface}) > kValidityLimit)
    most = std::max<double>(most, kOcclusionKeyframes);
  for (const ObjectValidity& object : objects) {
    if (object.ok()) continue;
    has_new_edges |= object.beside_edges > kObjectLimit;
    if (changes(object)) most = std::max({most, static_cast<double>(kOcclusionKeyframes), object.turn / kKeyframeTurn});
  }
  if (has_new_edges) most = std::max({most, 2.0, kMostPerHalfZone * edge_slide / kEdgeLimit});
  return static_cast<int>(std::ceil(std::min<double>(most, kMaxKeyframes)));
}

bool Validity::shares_hold() const {
  return std::max({shares.slid, shares.left, shares.blocked, shares.turned, shares.beside_edges, shares.new_surface}) <=
         kValidityLimit;
}

std::vector<std::string> Validity::warnings() const {
  std::vector<std::string> out;
  if (shares.slid > kValidityLimit) out.push_back(slide_warning(*this));
  if (shares.left > kValidityLimit) {
    out.push_back(percent(shares.left) + " of the power is reflected at points that leave the surface around them " +
                  where(*this) + ", over an edge or a crease. " + less_at_once(*this));
  }
  if (shares.blocked > kValidityLimit) {
    out.push_back("Something comes in the way of " + percent(shares.blocked) + " of the power " + where(*this) + ". " +
                  less_at_once(*this) + most_of(*this, &ValidityShares::blocked));
  }
  if (shares.turned > kValidityLimit) {
    out.push_back(percent(shares.turned) +
                  " of the power comes from surfaces that turn to or away from the rays, or reflect otherwise, " +
                  where(*this) + ". " + less_at_once(*this));
  }
  if (shares.beside_edges > kValidityLimit) {
    out.push_back("Edges of planes leave another share of " + percent(shares.beside_edges) + " of the power " +
                  where(*this) + ", by up to " + percent(largest_edge_change) + " of the field. " + advice(*this) +
                  most_of(*this, &ValidityShares::beside_edges));
  }
  if (shares.new_surface > kValidityLimit) {
    out.push_back(percent(shares.new_surface) + " of what is seen " + where(*this) +
                  " was hidden from the trace: its echoes are missing. " + advice(*this) +
                  most_of(*this, &ValidityShares::new_surface));
  }
  const bool is_any_off = !std::ranges::all_of(objects, &ObjectValidity::ok);
  if (is_radar_too_fast && is_any_off) out.push_back(fast_warning("The radar", turn_of_radar, *this));
  for (const ObjectValidity& object : objects) {
    const std::string warning = object.ok() ? "" : object_warning(object, *this);
    if (!warning.empty()) out.push_back(warning);
  }
  return out;
}

std::string Validity::text() const {
  const std::vector<std::string> found = warnings();
  std::string text = found.empty() ? "one trace serves this frame" : "one trace does not serve this frame";
  if (has_array) text += " and this array";
  for (const std::string& warning : found) text += "\n* " + warning;
  const std::string sizes = radians(rms_phase_error) + " rms, " + radians(largest_phase_error) + " at most";
  text += line(specular == SpecularPoints::kMaterial ? "reflection slides" : "slides, one Newton step",
               sizes + ", more than " + radians(kPhaseLimit) + " for " + percent(shares.slid) + " of the power");
  text += line("reflection leaves its surface", percent(shares.left));
  text += line("something comes in the way", percent(shares.blocked));
  text += line("surfaces turn", percent(shares.turned));
  text += line("edges of planes come near", percent(shares.beside_edges));
  text += line("surface that was hidden", percent(shares.new_surface));
  return text + object_lines(*this);
}

}  // namespace echopath
