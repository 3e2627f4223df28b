#pragma once
// Plans what the paths of a block share: points, mirrors, images of antennas, legs. One ray makes a path for each pair of
// mirror chains to its hits, so most paths consist of two legs that other paths have too.
#include <array>
#include <span>

#include "echopath/replay/evaluate/dense_ids.h"
#include "echopath/replay/evaluate/segment_ids.h"
#include "echopath/replay/posed/local_paths.h"
#include "echopath/replay/posed/specular_slide.h"

namespace echopath {

struct SharedLegPlan {
  static constexpr uint32_t kNone = ~uint32_t{0};

  // Describes an image of the antennas over mirrors, for transmitters and receivers alike: it is the image `parent`
  // reflected in `mirror`. Image 0 is the antenna itself.
  struct Image {
    uint32_t parent, mirror;
  };
  // A leg runs from an image of each transmitter (or of each receiver) to a point.
  struct Leg {
    uint32_t image, point;
    bool of_receivers;
  };
  // Describes the part of a path between its first and its last material point: hits [begin, end) of `inner_points`.
  struct Inner {
    size_t begin, end;
    uint64_t diffuse, image;  // bit per hit
  };
  // Describes a path over material points that is none of the single bounces.
  struct ChainPath {
    size_t place;         // of the path among those of its block
    int64_t path;         // index in the record
    uint32_t start, end;  // indices into `legs`, in the order in which the path was traced
    uint32_t inner;       // index into `inner`; kNone: nothing lies between, where one point on a rigid mesh is all
    uint32_t slide;       // index into `sliding`; kNone: its points of reflection stay where they were recorded
    bool is_reversed;     // it starts at a receiver
    bool is_coherent;     // it has a launch cell, at the point of its last leg
    std::complex<double> weight;
  };
  // A path over flagged mirrors alone is a straight line from an image of the transmitter to the receiver.
  struct MirrorPath {
    size_t place;
    int64_t path;
    uint32_t image;
    std::complex<double> weight;
  };

  // Names a path that others evaluate.
  struct PlannedPath {
    size_t place;
    int64_t path;
  };

  // Lists the paths that one point sends straight back: at most one coherent and one diffuse path.
  struct SingleBounce {
    static constexpr int64_t kNoPath = -1;
    const Hit* hit;
    int64_t path[2];  // SingleBounceSlots::Kind
    size_t place[2];
    bool has_path(size_t kind) const { return path[kind] != kNoPath; }
  };

  std::vector<SingleBounce> single_bounces;  // by place
  std::vector<Hit> points;                   // distinct hits, of the chains
  std::vector<Hit> mirrors;                  // distinct planes: triangles at their first corner, of curved mirrors each hit
  std::vector<Image> images;
  std::vector<Leg> legs;
  std::vector<uint32_t> inner_points;
  std::vector<Inner> inner;
  std::vector<ChainPath> chains;  // by place
  std::vector<int64_t> sliding;   // paths whose points of reflection move (SpecularPoints::kFermat)
  std::vector<MirrorPath> mirror_paths;
  std::vector<PlannedPath> edge_paths;   // edge_echoes.h
  std::vector<PlannedPath> lobed_paths;  // lobe_factors.h; they stand among the others, too

  void clear();
};

// Makes one plan after the other and keeps its memory from record to record. It serves one thread at a time.
class SharedLegPlanner {
 public:
  // Sets the record whose blocks are planned from now on. All arguments must outlive this use. Where `with_single_bounces`
  // is set, paths with one flat point on a rigid mesh are listed apart from the other chains.
  void begin(const Paths& paths, const PathPreparer& preparer, SpecularPoints specular, bool with_single_bounces);
  // Returns the plan for the paths of these indices; it is valid until the next call.
  const SharedLegPlan& operator()(std::span<const int64_t> indices);
  // Removes the paths whose places are marked ([P], 1 or 0) from the plan and renumbers the places of the others without
  // gaps. Points and legs that removed paths used stay in the plan.
  void leave_out(const std::vector<uint8_t>& places);

 private:
  struct TracedHits;
  struct Ends;
  // Remembers the run of hits that was looked up last: most paths share an end with the path before.
  struct Known {
    const Hit* hits = nullptr;
    int count = 0;
    bool of_receivers = false;
    uint32_t leg = 0;
  };

  void clear();
  static bool is_same(const Known& known, const Known& run);
  bool is_image(const TracedHits& hits, int k) const;
  Ends ends_of(const TracedHits& hits) const;
  bool is_single_bounce(size_t path) const;
  bool add_single_bounce(size_t place, int64_t path);
  void add_chain(size_t place, int64_t path);
  uint32_t slide_of(int64_t path, const Ends& ends);
  uint32_t start_leg(const TracedHits& hits, int first);
  uint32_t end_leg(const TracedHits& hits, int last);
  uint32_t image_in(uint32_t parent, const Hit& hit);
  uint32_t point(const Hit& hit);
  uint32_t straight_leg(const Hit& hit, bool of_receivers);
  uint32_t add_leg(const SharedLegPlan::Leg& leg);
  uint32_t leg_over_mirrors(uint32_t image, const Hit& hit, bool of_receivers);
  uint32_t inner(const TracedHits& hits, const Ends& ends, bool is_coherent);

  const Paths* paths_ = nullptr;
  const PathPreparer* preparer_ = nullptr;
  bool slides_ = false, with_single_bounces_ = false;
  SharedLegPlan plan_;
  Known last_start_, last_end_;
  const Hit* last_hit_ = nullptr;  // hit whose point was looked up last, often an end of the next path
  uint32_t last_point_ = 0;
  std::vector<std::array<uint32_t, 2>>
      straight_;                     // [point] legs from the antennas themselves: of transmitters, of receivers
  SegmentIds leg_of_, inner_of_[2];  // legs over mirrors; inner parts: as recorded, reversed
  DenseIds mirror_ids_, image_ids_, point_ids_, leg_ids_;
  std::vector<uint32_t> leg_over_mirrors_;  // by leg_ids_
};

}  // namespace echopath
