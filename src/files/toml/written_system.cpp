// The numbers of a system as they were written, in twice the digits of a double.
#include "trust/written_system.hpp"
#include "carom/base/error.hpp"
#include "carom/files/system_file.hpp"
#include "certify/number/exact_value.hpp"

namespace carom {

using trust::WrittenSystem;

namespace {

using certify::Ball;
using certify::BallVector;

Twofold twofold(const Ball& x) {
  const double high = x.to_double();
  return {high, (x - Ball(high)).to_double()};
}
trust::TwofoldVector twofold(const BallVector& v) { return {twofold(v.x), twofold(v.y)}; }

void write_start(const ExactSystem& exact, const System& system, trust::WrittenSystem& written) {
  if (system.initial.kind != InitialCondition::Kind::point) return;
  const ExactStart& start = exact.start;
  written.position =
      twofold(BallVector{certify::value_of(start.position.x), certify::value_of(start.position.y)});
  BallVector direction{certify::value_of(start.direction.x), certify::value_of(start.direction.y)};
  if (start.angle) {
    const certify::CosSin d = certify::direction_of(*start.angle);
    direction = {d.cos, d.sin};
  }
  const Ball scale = certify::value_of(exact.speed) / sqrt(dot(direction, direction));
  written.velocity = twofold(BallVector{scale * direction.x, scale * direction.y});
}

}  // namespace

std::shared_ptr<const trust::WrittenSystem> written_system(const LoadedSystem& loaded) {
  const certify::Precision precision(160);
  const ExactSystem& exact = loaded.exact;
  trust::WrittenSystem written;
  try {
    const certify::BallTable table = certify::ball_table(*exact.spec);
    const auto convert = [](const Ball& x) { return twofold(x); };
    for (const certify::WallOf<Ball>& wall : table.walls)
      written.table.walls.push_back(certify::converted<Twofold>(wall, convert));
    if (table.lattice)
      written.table.lattice = {twofold(table.lattice->first), twofold(table.lattice->second)};
  } catch (const InputError&) {
    return nullptr;  // a shape without certified form: its doubles are meant
  }
  if (loaded.system.of_discs() || exact.speed.to_double() == 0.0) return nullptr;
  written.omega = twofold(certify::value_of(exact.omega));
  written.speed = twofold(certify::value_of(exact.speed));
  write_start(exact, loaded.system, written);
  return std::make_shared<const trust::WrittenSystem>(std::move(written));
}

}  // namespace carom
