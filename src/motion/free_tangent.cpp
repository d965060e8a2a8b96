#include "motion/free_tangent.hpp"

#include <cmath>
#include <variant>

#include "carom/base/elementary.hpp"

namespace carom::motion {

using geometry::CurveFrame;
using geometry::Vector;

WallForm<double> wall_form(const geometry::Curve& curve) {
  WallForm<double> form;
  // M = k^2 p p^T + q q^T with the unit vector p along `axis` and k = ratio.
  const auto ellipse = [&](const Vector& axis, double ratio) {
    const double k2 = ratio * ratio, weight = (k2 - 1.0) / dot(axis, axis);
    form.xx = 1.0 + weight * (axis.x * axis.x);
    form.xy = weight * (axis.x * axis.y);
    form.yy = 1.0 + weight * (axis.y * axis.y);
    form.determinant = k2;
  };
  const CurveFrame frame = geometry::frame_of(curve);
  if (frame.kind == CurveFrame::Kind::segment) {
    const Vector normal = geometry::normal_at(frame, 0.0);
    form.normal_x = normal.x;
    form.normal_y = normal.y;
    return form;
  }
  form.center_x = frame.middle.x;
  form.center_y = frame.middle.y;
  form.xx = form.yy = form.determinant = 1.0;
  if (const auto* arc = std::get_if<geometry::EllipticArc>(&curve))
    ellipse(arc->axis, arc->ratio);
  else if (const auto* whole = std::get_if<geometry::Ellipse>(&curve))
    ellipse(whole->axis, whole->ratio);
  return form;
}

void FreeTangent::begin(const State& start, const Particle& particle, double unit_length) {
  omega = particle.omega;
  square = particle.speed * particle.speed;
  unit = unit_length / particle.speed;
  // Neither along nor across anything that a table prefers.
  deviation[0] = {0.6, 0.8 / unit};
  deviation[1] = {-0.8, 0.6 / unit};
  shrunk[0] = shrunk[1] = 0.0;
  last = start;
}

namespace {
/// transverse_kick with the inward normal |T| n of a Bézier curve.
double kick_of(const geometry::BezierForm& curve, const State& state, double square, double omega) {
  const Vector g = left(curve.tangent(state.u));
  const double bend = -curve.curvature(state.u) * std::sqrt(dot(g, g));
  return 2.0 * (square * bend - omega * dot(right(g), state.velocity)) / dot(g, state.velocity);
}
}  // namespace

void FreeTangent::hit(const TangentWalls& table, const State& state) {
  const auto wall = static_cast<std::size_t>(state.wall);
  const double kick =
      !table.beziers.empty() && table.beziers[wall]
          ? kick_of(*table.beziers[wall], state, square, omega)
          : transverse_kick(table.walls[wall], state.position, state.velocity, square, omega);
  TransverseFlight<double> flight{};
  if (omega != 0.0) {
    Vector way = state.position - last.position;
    if (table.lattice)
      way = way + table.lattice->translation(
                      {state.cell.first - last.cell.first, state.cell.second - last.cell.second});
    flight = flight_over(way, last.velocity, 1.0 / square, omega);
  }
  const double duration = state.time - last.time;
  for (int i = 0; i < 2; ++i) {
    Transverse& w = deviation[i];
    w = reflected(omega == 0.0 ? flown(w, duration) : flown(w, flight), kick);
    if (!(std::fabs(w.place) + std::fabs(unit * w.rate) > long_deviation)) continue;
    w.place *= 1.0 / long_deviation;
    w.rate *= 1.0 / long_deviation;
    shrunk[i] += 1.0;
  }
  last = state;
}

std::array<double, 2> FreeTangent::logarithms(double time) const {
  const double duration = Time(time) - last.time;
  const auto of = [&](int i) {
    const Transverse w =
        omega == 0.0
            ? flown(deviation[i], duration)
            : flown(deviation[i], transverse_flight(flight_tangent(omega, duration), omega));
    const double rate = unit * w.rate;
    return 0.5 * elementary::log(w.place * w.place + rate * rate) +
           log_of_long_deviation * shrunk[i];
  };
  return {of(0), of(1)};
}

}  // namespace carom::motion
