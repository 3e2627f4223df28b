#pragma once
// Ghost families: which object an echo belongs to and how it went there, from the hits of its path.
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

#include "echopath/label/partition.h"
#include "echopath/label/surfaces.h"

namespace echopath {

struct Family {
  std::string object;            // empty: background
  int ghost_type = 0;            // 0: real echo or background
  int order = 0;                 // bounces; 1: real echo, 0: background
  std::vector<std::string> via;  // what mirrored it, each once, in the order of the first bounce on it

  // The label of the dataset, four digits CMTO without the class: 1000 C is to be added (1 pedestrian, 2 cyclist, 3 car,
  // 4 large vehicle, 5 motorcycle). M is 1, as for objects whose ghosts are told apart. 111: real; 112: type 1 of order 2;
  // 122: type 2 of order 2; 124: type 2 of order 3 (orders are bits there). The dataset leaves every other ghost
  // undecided: 100. Background has 0 and no class.
  int class_code() const;
  // For people, "walker: type 2, order 3 via wall_left"; "walker"; "background". Objects may be called so too.
  std::string name() const;
  // Differs where families do: the fields, each after the first behind kBetweenFields; empty for the background.
  std::string key() const;
  auto operator<=>(const Family&) const = default;
};

inline constexpr char kBetweenFields = '\x1e';  // grouping.h: kBetweenNames is another

struct Families {
  // Those that occur, by object in the order of the list, order, type and surfaces; last the background, always.
  std::vector<Family> families;
  std::vector<uint32_t> family_of_path;  // [P] index into families

  Partition partition() const;  // names are those of Family::key
};

// `surfaces`: of the scene of the paths. The same for any number of threads. Raises Cancelled.
Families find_families(const Paths& paths, const SurfaceMap& surfaces, Job* job = nullptr);

}  // namespace echopath
