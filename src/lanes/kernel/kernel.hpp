// A kernel: one hit of every lane, stage by stage. What a stage finds it leaves in Stages.
//
//   choose   the piece of the walls that is hit next (straight.hpp, larmor.hpp; on lattices
//            next_disc.hpp, parallelograms.hpp, cells.hpp)
//   meet     where the flight meets it, and whether that is certain (met.hpp, ellipse.hpp)
//   divide   how long it takes: the divisions of all lanes together; along circles time
//   land     the next state, reflected; or a call to FreeLanes, where a trajectory ends, is looked
//            at or is undecided (landing.hpp)
//
// The files of this folder are compiled once for each instruction set (carom_kernels in
// CMakeLists.txt). Their headers open an unnamed namespace and use no container and no algorithm of
// the standard library: a weak symbol made of wide instructions could be linked into the rest of
// the program.
#pragma once

#include "lanes/kernel/landing.hpp"
#include "lanes/kernel/next_disc.hpp"
#include "lanes/kernel/stages.hpp"
#include "lanes/kernel/straight.hpp"

namespace carom::lanes {
namespace {

template <Kind kind>
void kernel(const LaneTable& __restrict table, LanePack& __restrict pack) {
  pack.calls = 0;
  Stages stages;
  if constexpr (kind.next_disc) {
    choose_next_disc<kind>(table, pack, stages);
  } else if constexpr (kind.cells && kind.single) {
    if (table.edges == 4)
      choose_parallelograms<kind>(table, pack, stages);
    else
      choose_hexagons<kind>(table, pack, stages);
  } else {
    for (int lane = 0; lane < pack.used; lane += width)
      choose_piece<kind>(table, pack, stages, lane);
    if constexpr (!kind.larmor && kind.convex && !kind.single)
      if (table.by_signs) look_up_exits(table, stages.piece, pack.used);
  }
  if constexpr (kind.next_disc) {
    for (int lane = 0; lane < pack.used; lane += width) pass_first_disc(table, pack, stages, lane);
    for (int lane = 0; lane < pack.used; lane += width)
      look_from_next_disc<kind>(table, pack, stages, lane);
    for (int lane = 0; lane < pack.used; lane += width)
      meet_next_disc<kind>(table, pack, stages, lane);
  } else if constexpr (!kind.larmor || kind.convex || kind.cells) {
    for (int lane = 0; lane < pack.used; lane += width) meet<kind>(table, pack, stages, lane);
  }
  if constexpr (divides_apart<kind>)
    for (int lane = 0; lane < pack.used; lane += width) divide<kind>(pack, stages, lane);
  if constexpr (kind.larmor)
    for (int lane = 0; lane < pack.used; lane += width) time(pack, stages, lane);
  for (int lane = 0; lane < pack.used; lane += width) land<kind>(table, pack, stages, lane);
  pack.sweep += 1.0;
}

}  // namespace
}  // namespace carom::lanes
