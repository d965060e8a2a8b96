// A table as lanes read it: plain numbers, one array a quantity, indexed by piece.
//
// A piece is a wall, or a part of one between the ends of its holes, so that the signs that name
// the wall of a hit also name the hole. Nothing here has a function: the kernels of every
// instruction set include it.
#pragma once

namespace carom::lanes {

template <int most>
struct LaneEllipses {
  bool any = false;
  bool of[most] = {};  ///< is the piece one, or an arc of one?
  double curve[most] =
      {};  ///< the wall, or the first one that is an arc of exactly the same ellipse
  // As in geometry::PreparedCurve: a unit vector along one axis, the weights of both; rows of the
  // map to the unit circle.
  double axis_x[most] = {}, axis_y[most] = {}, along[most] = {}, across[most] = {};
  double first_x[most] = {}, first_y[most] = {}, second_x[most] = {}, second_y[most] = {};
  double stretch[most] = {};  ///< bounds the form of unit vectors
  double shrink[most] = {};   ///< its inverse, which brings the form to squared lengths: below the
                              ///< square of the smaller semi-axis; 0: no ellipse
  // Margins of a landing; for other pieces they are those that always hold, or hold for all.
  double off[most] = {};       ///< of the step that brings a hit back
  double at_start[most] = {};  ///< closed curves: of the image's second coordinate from 0
  double inward[most] = {};    ///< of n.v in speeds
};

struct LaneTable {
  static constexpr int most = 64;               ///< pieces
  static constexpr int eight = 8, fewest = 16;  ///< numbers that may be read of each array

  int pieces = 0;
  int own = 0;  ///< the first of them: without the copies below
  int loops = 0;
  int first[most] = {}, count[most] = {};  ///< loops of pieces; a closed curve is a loop of one
  bool clockwise = false;                  ///< how Larmor circles turn
  bool convex = false;   ///< one loop, bent outwards or straight everywhere, and nothing in it
  bool by_line = false;  ///< the sides of the joints tell the exit of a straight flight from a wall
  bool by_signs =
      false;  ///< not convex: the sides of the joints do, by entries of `exit` (exit_by_signs.hpp)
  bool segments = false;  ///< has such pieces
  bool circles = false;
  bool closed_circles = false;
  double start_margin = 0.0;  ///< from the start of a closed circle's parameter
  bool small_circles =
      false;             ///< whose hits may be far from them, in radii (geometry::longest_step)
  bool open = false;     ///< beyond all walls lies the open plane
  bool divided = false;  ///< some wall, or ellipse of arcs, is of several pieces
  bool bent[most] = {};  ///< a circle, an ellipse or an arc of one
  bool closed[most] = {};

  // Start of each piece.
  double joint_x[most] = {}, joint_y[most] = {};
  // Of a segment: a point of it, and its unit normal out of the domain. Of a circle: centre, 1 / (2
  // r^2), r^2.
  double point_x[most] = {}, point_y[most] = {}, first_number[most] = {}, second_number[most] = {};
  double orientation[most] = {};  ///< circle: +1 domain inside, -1 outside; segment: 0
  double strength[most] = {};     ///< of its reflections: PreparedCurve::strength; segment: 2
  // For Larmor circles, of a piece with joints: the unit vector from the one to the other, their
  // distance. Of a circle: its radius, and the distance of the chord from the centre in radii,
  // positive if the centre lies on its left.
  double chord_x[most] = {}, chord_y[most] = {}, length[most] = {}, radius[most] = {},
         chord_offset[most] = {};
  // Of a piece with joints A and B: B - A, and A x B.
  double along_x[most] = {}, back_y[most] = {}, turn[most] = {};  ///< back_y = (A - B)_y
  double wall[most] = {};
  double hole[most] = {};  ///< -1: a wall
  double from[most] = {};  ///< parameter of the wall where it begins

  LaneEllipses<most> ellipses;

  // Of a lattice: the start and the direction of each edge of the cell, the cell beyond it and
  // where that begins; the two vectors.
  static constexpr double near_cell = 16.0, farthest_cell = 120.0;  ///< of a flight
  int edges = 0;                                                    ///< 4 or 6
  int steps = 2;                                                    ///< edges that a kernel crosses
  double edge_x[eight] = {}, edge_y[eight] = {}, edge_along_x[eight] = {}, edge_along_y[eight] = {};
  double beyond_first[eight] = {}, beyond_second[eight] = {}, beyond_x[eight] = {},
         beyond_y[eight] = {};
  double lattice_x[2] = {}, lattice_y[2] = {};
  // Larmor circles on a lattice: the pieces of all cells that they may come to, of which the first
  // `own` are the cell's. The piece that each is a copy of, and its cell; the walls of copies are
  // none.
  double copy_of[most] = {}, copy_first[most] = {}, copy_second[most] = {};
  // Where it has one disc: from there to the middle of the cell; and the size over its radius.
  double off_centre_x = 0.0, off_centre_y = 0.0, sizes_of_radius = 0.0;

  // Entries of `exit`: the piece of the start, and a bit for each joint on the right. They are sums
  // of halves, as is the number of joints on the right: start_step times the start, from_start, and
  // for each joint half its bit, less if it is on the left.
  static constexpr int most_signs = 10;
  static constexpr unsigned char unknown = most;
  double start_step = 1.0, from_start = 0.0;
  static constexpr int entries = 1 << 16;  ///< of `next_discs`, too; more than most_signs
                                           ///< 2^most_signs: as many as there are words of 16 bits
  unsigned char exit[entries] = {};

  // Which discs a flight may meet next that starts on a disc, or passes it (next_disc_table.hpp);
  // by its direction and by the side of that disc's centre. Four signed bytes, counted from that
  // disc: the cell of the disc that it meets if it cuts it, and else of the one that it then meets
  // or passes. Null: there is no table.
  static constexpr int disc_directions = 128,
                       disc_offsets = 64;  ///< of a quadrant; of a direction
  static constexpr unsigned two_discs(int first, int second, int then_first, int then_second) {
    return (static_cast<unsigned>(first) & 255u) | (static_cast<unsigned>(second) & 255u) << 8 |
           (static_cast<unsigned>(then_first) & 255u) << 16 |
           (static_cast<unsigned>(then_second) & 255u) << 24;
  }
  static constexpr unsigned no_discs = 0x7f7f7f7fu;  ///< beyond farthest_cell
  const unsigned* next_discs = nullptr;
  double directions_per_unit = 0.0,
         offsets_per_length = 0.0;  ///< of a unit vector's smaller coordinate
  // Lines nearer to a centre certainly cut the disc, up to near_cell or beyond it; farther ones
  // certainly pass it.
  double cut_within = 0.0, cut_within_far = 0.0, passed_beyond = 0.0;

  double order_margin = 0x1p-21;  ///< of two times, in sizes over the speed
  double size =
      0.0;  ///< the length by which every margin is measured: a power of two (make_lane_table.cpp)
};

}  // namespace carom::lanes
