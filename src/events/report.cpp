#include "carom/events/report.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace carom {

namespace {

const char* usual_reason(Fate fate) {
  switch (fate) {
    case Fate::singular:
      return "its path ends at a corner without a continuation, or runs along a wall";
    case Fate::lost:
      return "an internal error, please report it: it is outside of the table, or no wall follows";
    default:
      return "its motion could not be followed";
  }
}

}  // namespace

std::string report_of(const Particle& p, const State& s, Fate fate, std::string_view reason) {
  if (reason.empty()) reason = usual_reason(fate);
  const bool in_cell = s.cell != geometry::Cell{};
  const std::string cell =
      in_cell ? fmt::format(" in cell ({}, {})", s.cell.first, s.cell.second) : "";
  return fmt::format(
      "{}; {} at t = {}, x = {}, y = {}{}, vx = {}, vy = {}\twall {}, u {:a}, x {:a}, y {:a}, vx "
      "{:a}, vy {:a}, "
      "omega {:a}, cell {} {}, t {:a} + {:a}",
      reason, name_of(fate), s.time.value(), s.position.x, s.position.y, cell, s.velocity.x,
      s.velocity.y, s.wall, s.u, s.position.x, s.position.y, s.velocity.x, s.velocity.y, p.omega,
      s.cell.first, s.cell.second, s.time.high, s.time.low);
}

std::string_view shown(std::string_view report) {
  return report.substr(0, std::min(report.find('\t'), report.size()));
}

std::string_view bits_in(std::string_view report) {
  const std::size_t tab = report.find('\t');
  return tab == std::string_view::npos ? std::string_view() : report.substr(tab + 1);
}

}  // namespace carom
