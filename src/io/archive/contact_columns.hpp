// /contacts of a run's archive: hard discs that touch.
#pragma once

#include "carom/ensemble/run_rows.hpp"
#include "io/archive/columns.hpp"

namespace carom::io {

class ContactColumns {
 public:
  explicit ContactColumns(std::string file) : rows_(std::move(file)) {}

  void create(hid_t to) {
    for (const Column& c : integers) rows_.add<std::int32_t>(to, c.name, c.description);
    for (const Column& c : reals) rows_.add<double>(to, c.name, c.description);
  }
  void open(hid_t from) {
    for (const Column& c : integers) rows_.open<std::int32_t>(from, c.name);
    for (const Column& c : reals) rows_.open<double>(from, c.name);
  }
  void add(const ContactRow& r) {
    rows_.row(r.first, r.second, r.t, r.first_x, r.first_y, r.second_x, r.second_y, r.dx, r.dy,
              r.first_vx, r.first_vy, r.second_vx, r.second_vy, r.transfer);
  }
  void close() { rows_.close(); }

 private:
  struct Column {
    const char* name;
    hdf5::Description description;
  };
  static constexpr Column integers[] = {{"first", {"1", "Index of one disc, the smaller"}},
                                        {"second", {"1", "Index of the other"}}};
  static constexpr Column reals[] = {
      {"t", {"time", "Time of the contact"}},
      {"first_x", {"length", "Centre of the first, unwrapped"}},
      {"first_y", {"length", "Centre of the first, unwrapped"}},
      {"second_x", {"length", "Centre of the second, unwrapped"}},
      {"second_y", {"length", "Centre of the second, unwrapped"}},
      {"dx", {"length", "From the second's centre to the first's, of the copies that touch"}},
      {"dy", {"length", "From the second's centre to the first's, of the copies that touch"}},
      {"first_vx", {"length/time", "Velocity of the first after the contact"}},
      {"first_vy", {"length/time", "Velocity of the first after the contact"}},
      {"second_vx", {"length/time", "Velocity of the second after the contact"}},
      {"second_vy", {"length/time", "Velocity of the second after the contact"}},
      {"transfer", {"momentum", "Momentum exchanged along the line of centres"}},
  };
  hdf5::Columns rows_;
};

}  // namespace carom::io
