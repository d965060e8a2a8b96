#include "certify/enclosure/error_set.hpp"

#include "certify/enclosure/state_enclosure.hpp"

namespace carom::certify {

void ErrorSet::move(const Jacobian& J, const std::array<Interval, 4>& times) {
  for (std::size_t j = 0; j < 4; ++j)
    time_ = time_ + size_of(times[j]) * size(static_cast<Direction>(j));
  Bound fresh[4];  // what arrives besides the images of the two directions of the box
  for (std::size_t i = 0; i < 4; ++i) {
    fresh[i] = size_of(J[i][off]) * size(off) + size_of(J[i][speed]) * size(speed);
    if (i == off || i == speed)
      fresh[i] =
          fresh[i] + size_of(J[i][along]) * size(along) + size_of(J[i][turning]) * size(turning);
  }
  off_ = fresh[off];
  speed_ = fresh[speed];
  box_.move({{J[along][along], J[along][turning]}, {J[turning][along], J[turning][turning]}},
            {fresh[along], fresh[turning]});
}

void ErrorSet::round(const Bound& size, const Bound& of_time) {
  box_.round(size);
  off_ = off_ + size;
  speed_ = speed_ + size;
  time_ = time_ + of_time;
}

}  // namespace carom::certify
