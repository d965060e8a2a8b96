#include "files/svg/drawing.hpp"

#include <algorithm>
#include <utility>

#include "base/printable.hpp"

namespace carom::files {
namespace {

constexpr std::size_t most_pieces = 1000000;

bool is_one_of(std::string_view word, const std::vector<std::string>& words) {
  return std::find(words.begin(), words.end(), word) != words.end();
}

const std::vector<std::string> drawn{"path", "circle",  "ellipse", "rect",
                                     "line", "polygon", "polyline"};
const std::vector<std::string> groups{"svg", "g", "a", "switch"};
// What draws nothing that could be a wall; it is passed with all that it holds.
constexpr std::string_view passed =
    " animate animateMotion animateTransform clipPath color-profile cursor defs desc filter "
    "font font-face foreignObject image linearGradient marker mask metadata pattern "
    "radialGradient script set style symbol text title view ";

/// Is the element, with all in it, switched off? Style sheets are not read.
bool is_hidden(const XmlTag& tag) {
  if (const XmlAttribute* display = tag.find("display"); display && display->value == "none")
    return true;
  const XmlAttribute* style = tag.find("style");
  if (style == nullptr) return false;
  std::string text;
  for (const char c : style->value)
    if (c != ' ' && c != '\t' && c != '\n' && c != '\r') text += c;
  text = ";" + text + ";";
  return text.find(";display:none;") != std::string::npos ||
         text.find(";display:none!important;") != std::string::npos;
}

class Reader {
 public:
  Reader(std::string_view svg, const std::string& file, const Rational& scale)
      : locator_(svg, file), xml_(svg, locator_), inside_{{scale, 0, 0, -scale, 0, 0}} {}

  std::vector<Stroke> strokes() {
    XmlTag tag;
    std::size_t hidden = 0;  // how deep within what is passed
    bool root = true;
    while (xml_.next(tag)) {
      if (root && tag.name != "svg")
        throw InputError(place(tag), "<" + std::string(tag.name) + "> is no drawing",
                         "an SVG file, which begins with <svg");
      const bool alone = tag.opens && tag.closes;
      if (hidden > 0 || (tag.opens && passes(tag))) {
        if (!alone && tag.opens) ++hidden;
        if (!alone && tag.closes) --hidden;
      } else if (!tag.opens) {
        if (is_one_of(tag.name, groups)) inside_.pop_back();
      } else if (is_one_of(tag.name, groups)) {
        if (tag.name == "svg" && !root)
          throw InputError(place(tag), "a drawing within a drawing", "one <svg>");
        Affine within = transform(tag);
        if (!alone) inside_.push_back(std::move(within));
      } else {
        draw(tag);
      }
      root = false;
    }
    return std::move(strokes_);
  }

 private:
  Place place(const XmlTag& tag) const { return locator_.at(tag.offset); }

  bool passes(const XmlTag& tag) const {
    const std::string name(tag.name);
    if (passed.find(" " + name + " ") != passed.npos || name.find(':') != std::string::npos ||
        is_hidden(tag))
      return true;
    if (is_one_of(name, drawn) || is_one_of(name, groups)) return false;
    if (name == "use")
      throw InputError(place(tag), "<use> draws a copy of something else, and copies are not read",
                       "the copy itself: drawing programs can unlink it");
    std::vector<std::string> known = drawn;
    known.insert(known.end(), groups.begin(), groups.end());
    std::string list;
    for (const std::string& one : known) list += (list.empty() ? "" : ", ") + one;
    throw InputError(place(tag), "unknown element <" + base::printable(name) + ">",
                     "one of " + list, nearest_name(name, known));
  }

  Affine transform(const XmlTag& tag) const {
    const XmlAttribute* written = tag.find("transform");
    if (written == nullptr) return inside_.back();
    const Affine whole = inside_.back().after(transform_of(*written, locator_));
    check_size(whole, locator_.at(written->offset));
    return whole;
  }

  const XmlAttribute& attribute(const XmlTag& tag, const char* name) const {
    if (const XmlAttribute* found = tag.find(name)) return *found;
    throw InputError(place(tag), "<" + std::string(tag.name) + "> has no '" + name + "'",
                     std::string(name) + "=\"…\"");
  }
  Rational length(const XmlTag& tag, const char* name) const {
    return Scanner(attribute(tag, name), locator_).length(name);
  }
  Rational length_or_0(const XmlTag& tag, const char* name) const {
    return tag.find(name) == nullptr ? Rational(0) : length(tag, name);
  }
  Rational size(const XmlTag& tag, const char* name) const {
    const Rational value = length(tag, name);
    if (value > 0) return value;
    throw InputError(locator_.at(attribute(tag, name).offset),
                     std::string("'") + name + "' is not above 0", "a positive length");
  }

  void draw(const XmlTag& tag) {
    Pen pen(transform(tag));
    if (tag.name == "path") {
      draw_path(attribute(tag, "d"), locator_, pen);
    } else if (tag.name == "circle") {
      const Rational r = size(tag, "r");
      pen.ellipse({length_or_0(tag, "cx"), length_or_0(tag, "cy")}, r, r, place(tag));
    } else if (tag.name == "ellipse") {
      const Rational rx = size(tag, "rx"), ry = size(tag, "ry");
      pen.ellipse({length_or_0(tag, "cx"), length_or_0(tag, "cy")}, rx, ry, place(tag));
    } else if (tag.name == "rect") {
      rectangle(tag, pen);
    } else if (tag.name == "line") {
      pen.move({length_or_0(tag, "x1"), length_or_0(tag, "y1")}, place(tag));
      pen.line({length_or_0(tag, "x2"), length_or_0(tag, "y2")}, place(tag));
    } else {
      points(attribute(tag, "points"), tag.name == "polygon", pen);
    }
    name(tag, pen.strokes());
  }

  void points(const XmlAttribute& list, bool close, Pen& pen) const {
    Scanner text(list, locator_);
    text.skip_spaces();
    for (bool first = true; !text.at_end(); first = false) {
      const Place place = text.place();
      const Rational x = text.number("a coordinate");
      text.skip_separator();
      const Rational y = text.number("a second coordinate");
      text.skip_separator();
      if (first) {
        pen.move({x, y}, place);
      } else {
        pen.line({x, y}, place);
      }
    }
    if (close) pen.close(locator_.at(list.offset));
  }

  void rectangle(const XmlTag& tag, Pen& pen) const {
    const Rational x = length_or_0(tag, "x"), y = length_or_0(tag, "y"), w = size(tag, "width"),
                   h = size(tag, "height");
    const bool has_rx = tag.find("rx") != nullptr, has_ry = tag.find("ry") != nullptr;
    Rational rx = has_rx ? length(tag, "rx") : length_or_0(tag, "ry"),
             ry = has_ry ? length(tag, "ry") : rx;
    if (rx <= 0 || ry <= 0) rx = ry = 0;
    rx = std::min(rx, Rational(w / 2));
    ry = std::min(ry, Rational(h / 2));
    const Place at = place(tag);
    const auto corner = [&](const Rational& to_x, const Rational& to_y) {
      if (rx > 0) pen.arc(rx, ry, 0, false, true, {to_x, to_y}, at);
    };
    pen.move({x + rx, y}, at);
    pen.line({x + w - rx, y}, at);
    corner(x + w, y + ry);
    pen.line({x + w, y + h - ry}, at);
    corner(x + w - rx, y + h);
    pen.line({x + rx, y + h}, at);
    corner(x, y + h - ry);
    pen.line({x, y + ry}, at);
    corner(x + rx, y);
    pen.close(at);
  }

  // ID for one piece, ID_1, ID_2 … for several.
  void name(const XmlTag& tag, std::vector<Stroke> strokes) {
    std::string id;
    if (const XmlAttribute* written = tag.find("id")) {
      id = decoded(*written, locator_);
      if (base::printable(id) != id)
        throw InputError(locator_.at(written->offset),
                         "the id '" + base::printable(id) + "' has invisible characters",
                         "an id without control characters");
    }
    std::size_t count = 0, number = 0;
    for (const Stroke& stroke : strokes) count += stroke.chain.size();
    pieces_ += count;
    if (pieces_ > most_pieces)
      throw InputError(place(tag), "the drawing has too many pieces",
                       "at most " + std::to_string(most_pieces));
    for (Stroke& stroke : strokes) {
      for (table::shapes::NamedCurve& piece : stroke.chain) {
        ++number;
        if (!id.empty()) piece.name = count == 1 ? id : id + "_" + std::to_string(number);
      }
      strokes_.push_back(std::move(stroke));
    }
  }

  const Locator locator_;
  XmlReader xml_;
  std::vector<Affine> inside_;  ///< the transforms of the groups that are open
  std::vector<Stroke> strokes_;
  std::size_t pieces_ = 0;
};

}  // namespace

std::vector<DrawnLoop> loops_of_drawing(std::string_view svg, const std::string& file,
                                        const Rational& scale) {
  std::vector<DrawnLoop> loops = joined(Reader(svg, file, scale).strokes());
  if (loops.empty())
    throw InputError({file, 0, 0, ""}, "the drawing has no closed curve",
                     "a path, circle, ellipse, rect or polygon");
  return loops;
}

}  // namespace carom::files
