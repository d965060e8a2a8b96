// What lanes read of the ellipses of a table, one array a quantity, indexed by piece.
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

}  // namespace carom::lanes
