#pragma once
// A ghost family tells from the hits of a path which object an echo belongs to and how it went there.
//
// After the Radar Ghost Dataset (Kraus, Scheiner, Ritter, Dietmayer: "The Radar Ghost Dataset - An Evaluation of Ghost
// Objects in Automotive Radar Data", 2021). There an annotator sees where an echo appears, here the path is known:
//  * The owner is the first object of the list that the path touches; paths that touch none are background.
//  * Consecutive hits on one object are one bounce, also on another object than the owner: whatever happens within an
//    object (torso, then arm), the echo appears at it. Each hit on another surface is a bounce, since each makes an image.
//  * Ghosts over the same surfaces are one family wherever between them they meet the object: wall, object, floor and
//    object, wall, floor lie at two ranges, and are both of type 2 and order 3 via wall, floor.
//  * An echo of one bounce is real, whatever its number of hits. Of the others, type 1 left the scene from the owner last,
//    type 2 from something else; the order is the number of bounces.
#include <compare>
#include <cstdint>
#include <string>
#include <vector>

#include "echopath/label/objects/surfaces.h"
#include "echopath/label/partition.h"

namespace echopath {

struct Family {
  std::string object;            // empty for the background
  int ghost_type = 0;            // 0 for real echoes and the background
  int order = 0;                 // bounces; 1 for real echoes, 0 for the background
  std::vector<std::string> via;  // surfaces that mirrored it, each once, by the first bounce

  // Returns the label of the dataset, four digits CMTO without the class: 1000 C is to be added (1 pedestrian, 2 cyclist, 3
  // car, 4 large vehicle, 5 motorcycle). M is 1, as for objects whose ghosts are told apart. 111 is real, 112 type 1 of
  // order 2, 122 type 2 of order 2, and 124 type 2 of order 3 (orders are bits there). The dataset leaves every other ghost
  // undecided, 100. Background has 0 and no class.
  int class_code() const;
  // Returns a name for people: "walker: type 2, order 3 via wall_left", "walker" or "background". Objects may have such
  // names too.
  std::string name() const;
  // Returns a key that differs where families do: all fields, separated by kBetweenFields; empty for the background.
  std::string key() const;
  auto operator<=>(const Family&) const = default;
};

inline constexpr char kBetweenFields = '\x1e';  // grouping.h: kBetweenNames is another

struct Families {
  // These are the families that occur, sorted by object (in the order of the list of objects), then by order, type and
  // surfaces. The background is always the last.
  std::vector<Family> families;
  std::vector<uint32_t> family_of_path;  // [P] index into families

  Partition partition() const;  // names are those of Family::key
};

// Finds the family of each path. `surfaces` are those of the paths' scene. The result does not depend on the threads. Raises
// Cancelled.
Families find_families(const Paths& paths, const SurfaceMap& surfaces, Job* job = nullptr);

}  // namespace echopath
