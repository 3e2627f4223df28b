#include "echopath/replay/factors/path_passages.h"

#include <algorithm>
#include <cmath>

#include "echopath/base/constants.h"
#include "echopath/em/layers/sheet_model.h"

namespace echopath {
namespace {

constexpr size_t kManyPasses = 4096;  // as many as it costs to make a table
constexpr double kBeside = 0.5;       // of a triangle's edges: so far beside it a curved surface is followed

// Returns the unit vector across the ray that leads toward the normal through its point of entry.
Vec3 toward_foot(const Vec3& direction, const Vec3& normal) {
  const Vec3 ahead = direction.dot(normal) > 0.0 ? normal : Vec3(-normal), across = ahead - ahead.dot(direction) * direction;
  const double size = across.norm();
  return size > 1e-9 ? Vec3(across / size) : Vec3(Vec3::Zero());
}

}  // namespace

RecordSheets::RecordSheets(const PathPreparer& of, const ChirpSequence& waveform)
    : preparer(of), wavelength(kSpeedOfLight / waveform.start_frequency) {
  const Paths& paths = preparer.paths();
  if (paths.passes.empty()) return;
  polarization = paths.mode_polarization();
  of_mesh.resize(paths.scene->meshes().size());
  for (const Pass& pass : paths.passes) {
    std::optional<Sheet>& sheet = of_mesh[pass.hit.mesh_id];
    if (sheet) continue;
    const Material& material = *paths.scene->node_of(pass.hit.mesh_id).material;
    const SheetModel model(material, waveform.start_frequency, waveform.band());
    sheet = Sheet{model, std::nullopt};
    if (paths.passes.size() > kManyPasses) sheet->table.emplace(model);
  }
}

PathPassages::PathPassages(const RecordSheets& sheets, int64_t path)
    : shared_(sheets), paths_(sheets.preparer.paths()), passes_(paths_.passes_of(path)) {
  const int edge = edge_hit(paths_.flags[path]), num_edges = num_edge_hits(paths_.flags[path]);
  count_ = paths_.num_bounces[path];
  for (int k = 0; k < count_; ++k) {
    const Hit& hit = paths_.hits_of(path)[k];
    hits_.push_back(shared_.preparer.hit(hit, normals_));
    const bool is_edge = edge >= 0 && k >= edge && k < edge + num_edges, is_diffuse = (paths_.diffuse[path] >> k & 1) != 0;
    is_image_.push_back(!is_edge && !is_diffuse && shared_.preparer.is_image(hit.mesh_id, paths_.stratum[path]));
  }
  if (!paths_.jones.empty()) {
    first_edge_ = edge;
    num_edges_ = num_edges;
  }
  posed_.resize(hits_.size());
  for (const Pass& pass : passes_) sheets_.push_back(shared_.preparer.hit(pass.hit, normals_));
  posed_sheets_.resize(sheets_.size());
  for (first_material_ = 0; first_material_ < count_ && is_image_[at(first_material_)];) ++first_material_;
  for (last_material_ = count_ - 1; last_material_ >= 0 && is_image_[at(last_material_)];) --last_material_;
}

void PathPassages::pose(const PosedScene& scene) {
  scene_ = &scene;
  for (size_t k = 0; k < hits_.size(); ++k) pose_hit(hits_[k], scene, false, posed_[k]);
  for (size_t k = 0; k < sheets_.size(); ++k) pose_facet(sheets_[k], scene, posed_sheets_[k]);
  const Ends nowhere{Vec3::Zero(), Vec3::Zero()};
  start_.clear();
  end_.clear();
  if (first_material_ == count_) return;  // each pair of antennas has legs of its own
  for (const PosedAntenna& antenna : scene.transmitters)
    start_.push_back(passed(0, first_material_, {antenna.position, Vec3::Zero()}));
  inner_ = passed(first_material_ + 1, last_material_, nowhere);
  for (const PosedAntenna& antenna : scene.receivers)
    end_.push_back(passed(last_material_ + 1, count_, {Vec3::Zero(), antenna.position}));
}

PathPassages::Passed PathPassages::at_channel(size_t transmitter, size_t receiver) const {
  if (!start_.empty()) return start_[transmitter] * inner_ * end_[receiver];
  return passed(0, count_, {scene_->transmitters[transmitter].position, scene_->receivers[receiver].position});
}

FieldVector PathPassages::through(const LegOfAntenna& at, FieldVector field) const {
  const auto [begin, end] = passes_on(at.leg);
  if (begin == end) return field;
  const auto [from, to] = ends_of_leg(at.leg, {at.antenna, at.antenna});
  const Vec3 direction = (to - from).normalized();
  for (size_t k = 0; k < end - begin; ++k) {
    const Crossing met = crossing(at.is_forward ? begin + k : end - 1 - k, from, direction);
    const Vec3 across = direction.cross(met.normal);
    const Vec3 te = across.norm() > kMinSineOfModes ? Vec3(across.normalized()) : Vec3(Vec3::Zero());
    field = met.passage.tm * field + (met.passage.te - met.passage.tm) * te.dot(field) * te;
  }
  return field;
}

std::pair<size_t, size_t> PathPassages::passes_on(int leg) const {
  const auto leg_of = [](const Pass& pass) { return static_cast<int>(pass.leg); };
  return {std::ranges::lower_bound(passes_, leg, {}, leg_of) - passes_.begin(),
          std::ranges::upper_bound(passes_, leg, {}, leg_of) - passes_.begin()};
}

// Returns whether a leg between an antenna and an edge is one on which `through` follows the field.
bool PathPassages::is_of_field(int leg) const {
  return first_edge_ >= 0 && (leg <= first_edge_ || leg >= first_edge_ + num_edges_);
}

// Returns what the sheets do on the legs `first` to `last`, both included.
PathPassages::Passed PathPassages::passed(int first, int last, const Ends& ends) const {
  Passed all;
  for (size_t begin = passes_on(first).first; begin < passes_.size() && static_cast<int>(passes_[begin].leg) <= last;
       begin = passes_on(static_cast<int>(passes_[begin].leg)).second)
    all = all * passed_on_leg(static_cast<int>(passes_[begin].leg), ends);
  return all;
}

PathPassages::Passed PathPassages::passed_on_leg(int leg, const Ends& ends) const {
  const auto [from, to] = ends_of_leg(leg, ends);
  const double length = (to - from).norm();
  const Vec3 direction = (to - from) / length;
  const auto [begin, end] = passes_on(leg);
  Passed all;
  Vec3 offset = Vec3::Zero();
  for (size_t k = begin; k < end; ++k) {
    const Crossing met = crossing(k, from, direction);
    const SheetFactor factor = sheet_factor(met.passage, te_share(shared_.polarization, direction, met.normal));
    all = all * Passed{is_of_field(leg) ? 1.0 : factor.field, factor.delay};
    offset += met.passage.offset * toward_foot(direction, met.normal);
  }
  const double wavenumber = kTwoPi / shared_.wavelength;
  all.field *= std::polar(1.0, wavenumber * (all.delay - detour(offset, length, shared_.wavelength)));
  return all;
}

PathPassages::Crossing PathPassages::crossing(size_t pass, const Vec3& from, const Vec3& direction) const {
  const Vec3 normal = normal_at(pass, from, direction);
  return {normal, shared_.passage(sheets_[pass].mesh_id, std::min(1.0, std::abs(direction.dot(normal))))};
}

// Returns the normal of the sheet where a line crosses it.
Vec3 PathPassages::normal_at(size_t pass, const Vec3& from, const Vec3& direction) const {
  const LocalHit& sheet = sheets_[pass];
  PosedHit posed = posed_sheets_[pass];
  if (!sheet.normals) return posed.normal;
  const Vec3 across = posed.edge_u.cross(posed.edge_v);
  const double slope = direction.dot(across);
  LocalHit there = sheet;
  if (slope != 0.0) {
    const Vec3 corner = posed.point - sheet.u * posed.edge_u - sheet.v * posed.edge_v;
    const Vec3 point = from + across.dot(corner - from) / slope * direction - corner;
    there.u = std::clamp(point.cross(posed.edge_v).dot(across) / across.squaredNorm(), -kBeside, 1.0 + kBeside);
    there.v = std::clamp(posed.edge_u.cross(point).dot(across) / across.squaredNorm(), -kBeside, 1.0 + kBeside);
  }
  pose_hit(there, *scene_, false, posed);
  return posed.normal;
}

// Returns the points between which a leg runs, with the points of mirrors as their images show them.
std::pair<Vec3, Vec3> PathPassages::ends_of_leg(int leg, const Ends& ends) const {
  int before = leg - 1, behind = leg;
  while (before >= 0 && is_image_[at(before)]) --before;
  while (behind < count_ && is_image_[at(behind)]) ++behind;
  const Vec3 from = before < 0 ? ends.transmitter : posed_[at(before)].point;
  const Vec3 to = behind == count_ ? ends.receiver : posed_[at(behind)].point;
  // Toward each mirror from the point before, the wave travels to the image of the end over this mirror and all behind.
  const auto met = [&](const Vec3& start, int k) -> Vec3 {
    if (k == behind) return to;
    const PosedHit& mirror = posed_[at(k)];
    const Vec3 image = image_over_reversed(chain_of(posed_.data(), k, behind), to);
    return mirror.height(start) == mirror.height(image) ? start : mirror.met_on_line(start, image);
  };
  Vec3 start = from;
  for (int k = before + 1; k < leg; ++k) start = met(start, k);
  return {start, met(start, leg)};
}

}  // namespace echopath
