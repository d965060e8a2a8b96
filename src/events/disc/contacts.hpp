// Which discs touch next: predictions of contacts among free flights, and which discs are near.
#pragma once

#include <vector>

#include "carom/base/time.hpp"
#include "carom/geometry/lattice.hpp"
#include "carom/geometry/vector.hpp"

namespace carom::events {

struct PairStart;

/// The discs of a world. Every contact time is a function of the two states alone, the same
/// whichever of the two asks and whenever, so that a run that was interrupted repeats its bits.
///
/// Neighbours. Each disc has an anchor, from which it is never farther than `slack_` until `check`,
/// when it must be anchored anew. A disc that it touches before that is anchored within the sum of
/// the radii and twice the slack, that is in one of the nine bins around its own, if bins are that
/// wide. Where fewer than three bins fit side by side, all discs are asked, on a lattice in all
/// copies that can be reached.
class Contacts {
 public:
  struct Disc {
    geometry::Vector position, velocity;  ///< at `time`, in the frame of the cell it started in
    Time time;
    double omega = 0.0, radius = 0.0, speed = 0.0;
    bool here = true;  ///< false: gone, or not started
    // Its own next event, and until when its anchor holds.
    Time own, check;
    int own_kind = 0;
    // Its first contact before both, with its partner. `copy`: lattice vector from the partner to
    // the copy that is touched.
    Time meeting;
    geometry::Cell copy;
    int bin = -1;
  };

  explicit Contacts(const geometry::Lattice* lattice);

  void clear() {
    discs_.clear();
    partners_.clear();
  }
  void add(const Disc& disc) {
    discs_.push_back(disc);
    partners_.push_back(-1);
  }
  int size() const { return static_cast<int>(discs_.size()); }
  Disc& disc(int i) { return discs_[static_cast<std::size_t>(i)]; }
  const Disc& disc(int i) const { return discs_[static_cast<std::size_t>(i)]; }
  int partner(int i) const { return partners_[static_cast<std::size_t>(i)]; }  ///< -1: none

  /// Prepares bins for the discs there are and anchors all of them at `now`, or at their start if
  /// later.
  void prepare(const Time& now);
  /// Anchors a disc where it is at `now`.
  void anchor(int i, const Time& now);
  void leave(int i);
  /// Finds the first contact of i before its own next event and its check, and before the
  /// partner's: then the partner looks again.
  void predict(int i, const Time& now);
  /// Makes the contact of i its partner's, if it is the partner's first. Then both are in the
  /// queue, and the order of simultaneous contacts does not depend on which disc found them.
  bool tell_partner(int i);
  /// All whose first contact is with i.
  void partners_of(int i, std::vector<int>& found) const;

  /// x_i - x_j for the copy of j that is displaced by `copy`.
  geometry::Vector separation(geometry::Vector x, geometry::Vector y,
                              const geometry::Cell& copy) const {
    const geometry::Vector d = x - y;
    return lattice_ != nullptr && !(copy == geometry::Cell{}) ? d - lattice_->translation(copy) : d;
  }
  /// Does a new disc overlap another by more than rounding explains? Returns it, or -1.
  int overlapped(const Disc& disc) const;
  /// The largest radius that does not overlap its own copies; infinite without a lattice.
  double largest_radius() const;

 private:
  void first_contact(int i, int j, const Time& now, const Time& until);
  void try_copy(int i, int j, const PairStart& start, const geometry::Cell& copy, const Time& end);
  geometry::Cell nearest(geometry::Vector d) const;
  double reach_within(const Disc& disc, double duration) const;
  int bin_of(geometry::Vector x) const;
  void choose_bins(const Time& now);

  const geometry::Lattice* lattice_;
  std::vector<Disc> discs_;
  std::vector<int> partners_;  ///< apart: searches for the partners of a disc read these alone
  bool binned_ = false;
  double slack_ = 0.0;
  /// Unbinned: how far ahead one looks, in time, and in a disc's own way if that takes longer.
  double horizon_ = 0.0, spacing_ = 0.0;
  int columns_ = 0, rows_ = 0;
  geometry::Vector low_;               ///< without a lattice: corner of the bins
  double width_ = 0.0, height_ = 0.0;  ///< … and their sizes
  double unique_ = 0.0;                ///< half the shortest lattice vector
  geometry::Cell along_, beyond_;      ///< a basis: that vector and one to the next row
  std::vector<std::vector<int>> bins_;
};

}  // namespace carom::events
