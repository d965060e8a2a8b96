// The attribute d of a path.
#include <string>

#include "files/svg/pen.hpp"

namespace carom::files {
namespace {

constexpr const char* commands = "one of M, L, H, V, C, S, Q, T, A, Z, or a number";

class PathData {
 public:
  PathData(const XmlAttribute& data, const Locator& locator, Pen& pen)
      : text_(data, locator), pen_(pen) {}

  void draw() {
    text_.skip_spaces();
    if (text_.at_end()) return;
    if (text_.peek() != 'M' && text_.peek() != 'm') text_.fail("a path begins with M or m", "M");
    while (!text_.at_end()) {
      const char letter = text_.peek();
      if (std::string("MmLlHhVvCcSsQqTtAaZz").find(letter) == std::string::npos)
        text_.fail("no command of a path", commands);
      const Place place = text_.place();
      text_.take(letter);
      relative_ = letter >= 'a';
      const char command = relative_ ? static_cast<char>(letter - 'a' + 'A') : letter;
      if (command == 'Z') {
        pen_.set_decimals(text_.decimals());
        pen_.close(place);
        last_ = 'Z';
      } else {
        repeat(command);
      }
      text_.skip_spaces();
    }
  }

 private:
  // One command with as many groups of numbers as follow.
  void repeat(char command) {
    text_.skip_spaces();
    do {
      const Place place = text_.place();
      step(command, place);
      last_ = command;
      if (command == 'M') command = 'L';  // further points of a move are lines
      text_.skip_separator();
    } while (text_.at_number());
  }

  void step(char command, const Place& place) {
    const DrawnPoint from = pen_.at();
    switch (command) {
      case 'M':
        return pen_.move(point(), place);
      case 'L':
        return to_line(point(), place);
      case 'H':
        return to_line({number() + (relative_ ? from.x : Rational(0)), from.y}, place);
      case 'V':
        return to_line({from.x, number() + (relative_ ? from.y : Rational(0))}, place);
      case 'C':
      case 'S': {
        const DrawnPoint first = command == 'C' ? next() : mirrored('C', 'S');
        const DrawnPoint second = next();
        return to_bezier({first, second}, place);
      }
      case 'Q':
        return to_bezier({next()}, place);
      case 'T':
        return to_bezier({mirrored('Q', 'T')}, place);
      default:
        return to_arc(place);
    }
  }

  void to_line(const DrawnPoint& to, const Place& place) {
    if (relative_) pen_.count_relative();
    pen_.line(to, place);
  }
  void to_bezier(const std::vector<DrawnPoint>& control, const Place& place) {
    const DrawnPoint to = point();
    if (relative_) pen_.count_relative();
    pen_.bezier(control, to, place);
    control_ = control.back();
  }
  void to_arc(const Place& place) {
    const Rational rx = number(), ry = next_number(), angle = next_number();
    const bool large = text_.flag(), sweep = text_.flag();
    text_.skip_separator();
    const DrawnPoint to = point();
    if (relative_) pen_.count_relative();
    pen_.arc(rx, ry, angle, large, sweep, to, place);
  }

  Rational number() { return text_.number("a number of the path"); }
  Rational next_number() {
    text_.skip_separator();
    return number();
  }
  DrawnPoint point() {
    const Rational x = number(), y = next_number();
    return relative_ ? pen_.at() + DrawnPoint{x, y} : DrawnPoint{x, y};
  }
  /// A point before another.
  DrawnPoint next() {
    const DrawnPoint p = point();
    text_.skip_separator();
    return p;
  }
  /// The control point before the place, seen from the other side of it, where there is one.
  DrawnPoint mirrored(char curve, char smooth) const {
    const DrawnPoint at = pen_.at();
    return last_ == curve || last_ == smooth ? at + (at - control_) : at;
  }

  Scanner text_;
  Pen& pen_;
  bool relative_ = false;
  char last_ = 'Z';
  DrawnPoint control_;
};

}  // namespace

void draw_path(const XmlAttribute& data, const Locator& locator, Pen& pen) {
  PathData(data, locator, pen).draw();
}

}  // namespace carom::files
