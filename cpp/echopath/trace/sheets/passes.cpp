#include "echopath/trace/sheets/passes.h"

#include <algorithm>
#include <map>

#include "echopath/base/threads/parallel.h"
#include "echopath/em/layers/sheet_model.h"
#include "echopath/record/hit_points.h"

namespace echopath {
namespace {

constexpr int64_t kPathsTogether = 1 << 12;
constexpr double kLiftAbsolute = 1e-6, kLiftRelative = 0x1.0p-21;  // m, and of the coordinates: single precision

using Matrix2 = Eigen::Matrix2cd;

// Returns the IDs of the meshes that are sheets.
std::vector<uint32_t> sheets_of(const Scene& scene) {
  std::vector<uint32_t> ids;
  for (uint32_t id = 0; id < scene.meshes().size(); ++id) {
    if (scene.node_of(id).material->is_sheet()) ids.push_back(id);
  }
  return ids;
}

// Holds the passes of some paths in a row.
struct PassBlock {
  std::vector<Pass> passes;
  std::vector<int64_t> counts;  // by path
  int64_t num_stopped = 0;
};

void join(const std::vector<PassBlock>& blocks, Paths& paths) {
  paths.passes.clear();
  paths.pass_offsets.assign(1, 0);
  for (const PassBlock& block : blocks) {
    paths.passes.insert(paths.passes.end(), block.passes.begin(), block.passes.end());
    for (const int64_t count : block.counts) paths.pass_offsets.push_back(paths.pass_offsets.back() + count);
    paths.frame.statistics.num_stopped_passes += block.num_stopped;
  }
  if (paths.passes.empty()) paths.pass_offsets.clear();
}

}  // namespace

// Holds the sheets of a scene alone.
class SheetPasses::SheetScene {
 public:
  // `ids` names the sheets, of which there is at least one.
  SheetScene(const Scene& scene, std::vector<uint32_t> ids, double time, const RayRounding& rounding, Job* job)
      : scene_(scene), ids_(std::move(ids)) {
    std::vector<bool> is_sheet(scene.meshes().size());
    for (const uint32_t id : ids_) is_sheet[id] = true;
    scene_.keep_meshes(is_sheet);
    geometry_.update(scene_, PosedScene(scene_, time), rounding, job);
  }
  const std::vector<uint32_t>& ids() const { return ids_; }

  // Finds the next sheet at `begin` (m) or farther along the ray, with its own mesh ID.
  bool meets(const Vec3& from, const Vec3& direction, double begin, RayHit& met) const {
    if (geometry_.intersect_from_surface(from, direction, met, Sees::kSheets, begin) != EmbreeScene::Verdict::kHit)
      return false;
    met.hit.mesh_id = ids_[met.hit.mesh_id];
    return true;
  }
  double behind(const RayHit& met) const { return geometry_.behind(met.distance, met.reported); }
  const Vec3& origin() const { return geometry_.origin(); }  // m, world, to which its points are relative
  double reach() const { return geometry_.reach(); }         // m, beyond which rays are rounded no more

 private:
  Scene scene_;
  std::vector<uint32_t> ids_;
  EmbreeScene geometry_;
};

class SheetPasses::PassFinder {
 public:
  PassFinder(Paths& paths, const SheetScene& sheets)
      : paths_(paths), sheets_(sheets), pose_(*paths.scene, paths.frame.trace_time), origin_(sheets.origin()),
        polarization_(paths.mode_polarization()) {
    for (const uint32_t id : sheets.ids()) {
      const double frequency = paths.radar.waveform.start_frequency;  // of the fields, which alone count here
      models_.emplace(id, SheetModel(*paths.scene->node_of(id).material, frequency, {frequency, frequency}));
    }
  }

  PassBlock find(int64_t begin, int64_t end) const {
    PassBlock block;
    for (int64_t path = begin; path < end; ++path) {
      const size_t before = block.passes.size();
      find_passes(static_cast<size_t>(path), block);
      block.counts.push_back(static_cast<int64_t>(block.passes.size() - before));
    }
    return block;
  }

 private:
  struct LegEnd {
    Vec3 at;      // relative to the origin of the sheets
    Vec3 normal;  // of the sheet on which it lies, else zero
  };

  LegEnd end_of(const Hit& hit) const {
    const std::array<Vec3, 3> corners = pose_.world_triangle(hit.mesh_id, hit.triangle_id);
    const auto& [a, b, c] = corners;
    return {hit_point(corners, hit) - origin_,
            models_.contains(hit.mesh_id) ? Vec3(cross_of_sides(a, b, c).normalized()) : Vec3(Vec3::Zero())};
  }

  // Moves the end of a leg off its sheet, toward the other end.
  Vec3 lifted(const LegEnd& end, const Vec3& other) const {
    const double largest = std::max(end.at.cwiseAbs().maxCoeff(), other.cwiseAbs().maxCoeff());
    const double lift = kLiftAbsolute + kLiftRelative * std::min(largest, sheets_.reach());
    return end.at + std::copysign(lift, end.normal.dot(other - end.at)) * end.normal;
  }

  void find_passes(size_t path, PassBlock& block) const {
    const Hit* hits = paths_.hits_of(static_cast<int64_t>(path));
    const int count = paths_.num_bounces[path];
    LegEnd from{paths_.frame.transmitter - origin_, Vec3::Zero()};
    for (int leg = 0; leg <= count; ++leg) {
      const LegEnd to = leg < count ? end_of(hits[leg]) : LegEnd{paths_.frame.receiver - origin_, Vec3::Zero()};
      add_leg(path, {static_cast<uint32_t>(leg), leg == 0, leg == count}, lifted(from, to.at), lifted(to, from.at), block);
      from = to;
    }
  }

  struct LegPlace {
    uint32_t index;
    bool is_first, is_last;
  };
  void add_leg(size_t path, const LegPlace& leg, const Vec3& from, const Vec3& to, PassBlock& block) const {
    const Vec3 line = to - from;
    const double length = line.norm();
    const Vec3 direction = line / length;
    RayHit met;
    int count = 0;
    double begin = 0.0;
    while (sheets_.meets(from, direction, begin, met) && met.distance < length) {
      begin = sheets_.behind(met);
      if (++count > kMostPasses) {
        paths_.weight[path] = 0.0f;
        if (!paths_.jones.empty()) paths_.jones[path] = {};
        ++block.num_stopped;
        return;
      }
      block.passes.push_back({met.hit, leg.index});
      const bool is_edge = (paths_.flags[path] & kEdgePath) != 0;
      if (!paths_.jones.empty() && !is_edge && (leg.is_first || leg.is_last)) polarize(path, leg, direction, met);
    }
  }

  // Puts the passage of both modes, over what they make of the first transmitter's polarisation, to the end of the matrix at
  // which the leg lies.
  void polarize(size_t path, const LegPlace& leg, const Vec3& direction, const RayHit& met) const {
    const SheetPassage passage = models_.at(met.hit.mesh_id).passage(std::min(1.0, std::abs(direction.dot(met.normal))));
    const bool is_reversed = paths_.is_reversed(path);
    const TransverseBasis basis = transverse_basis(is_reversed ? Vec3(-direction) : direction);
    const Vec3 across = direction.cross(met.normal);
    const std::complex<double> co_polar = sheet_factor(passage, te_share(polarization_, direction, met.normal)).field;
    if (across.norm() < kMinSineOfModes || co_polar == 0.0) return;
    const Vec3 te = across.normalized();
    const Eigen::Vector2cd axis(te.dot(basis.horizontal), te.dot(basis.vertical));
    const Matrix2 of_te = axis * axis.transpose(), of_tm = Matrix2::Identity() - of_te;
    const Matrix2 through = passage.te / co_polar * of_te + passage.tm / co_polar * of_tm;
    JonesMatrix& entries = paths_.jones[path];
    Matrix2 matrix;
    for (int i = 0; i < 4; ++i) matrix(i / 2, i % 2) = std::complex<double>(entries[i]);
    // The columns of the matrix belong to the end at which the path was traced from.
    matrix = leg.is_first != is_reversed ? Matrix2(matrix * through) : Matrix2(through * matrix);
    for (int i = 0; i < 4; ++i) entries[i] = std::complex<float>(matrix(i / 2, i % 2));
  }

  Paths& paths_;  // each task changes its own paths
  const SheetScene& sheets_;
  PosedScene pose_;
  Vec3 origin_, polarization_;
  std::map<uint32_t, SheetModel> models_;  // by mesh ID
};

SheetPasses::SheetPasses(const Scene& scene, double trace_time, const RayRounding& rounding, Job* job) {
  std::vector<uint32_t> ids = sheets_of(scene);
  if (!ids.empty()) sheets_ = std::make_unique<const SheetScene>(scene, std::move(ids), trace_time, rounding, job);
}

SheetPasses::~SheetPasses() = default;

void SheetPasses::add_to(Paths& paths, Job* job) const {
  if (paths.num_paths() == 0 || !sheets_) return;
  const PassFinder finder(paths, *sheets_);
  std::vector<PassBlock> blocks(num_chunks(paths.num_paths(), kPathsTogether));
  Job own(job);
  parallel_for_chunks(paths.num_paths(), kPathsTogether,
                      [&](int64_t begin, int64_t end) { blocks[begin / kPathsTogether] = finder.find(begin, end); }, &own);
  join(blocks, paths);
}

}  // namespace echopath
