// /contacts of a run's archive: hard discs that touch.
#pragma once

#include "carom/events/event.hpp"
#include "carom/table/table.hpp"
#include "io/archive/columns.hpp"

namespace carom {

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
  void add(const ContactEvent& e, const Table& table) {
    const auto unwrapped = [&](geometry::Vector x, const geometry::Cell& cell) {
      return table.lattice ? x + table.lattice->translation(cell) : x;
    };
    const geometry::Vector x = unwrapped(e.first_position, e.first_cell),
                           y = unwrapped(e.second_position, e.second_cell);
    rows_.row(std::int32_t{e.first}, std::int32_t{e.second}, e.time.value(), x.x, x.y, y.x, y.y,
              e.separation.x, e.separation.y, e.first_after.x, e.first_after.y, e.second_after.x,
              e.second_after.y, e.transfer);
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

}  // namespace carom
