// Loops of strokes that end where others begin.
#include <map>
#include <utility>

#include "files/svg/drawing.hpp"
#include "table/closed_curves.hpp"

namespace carom::files {
namespace {

struct Before {
  bool operator()(const DrawnPoint& a, const DrawnPoint& b) const {
    return a.x != b.x ? a.x < b.x : a.y < b.y;
  }
};
using Ends = std::map<DrawnPoint, std::vector<std::size_t>, Before>;

std::string shown(const DrawnPoint& p) {
  return "(" + ExactNumber(nearest(p.x)).text() + ", " + ExactNumber(nearest(p.y)).text() + ")";
}

// Where the strokes end that are not closed: two by two.
Ends ends_of(const std::vector<Stroke>& strokes) {
  Ends ends;
  for (std::size_t k = 0; k < strokes.size(); ++k) {
    if (strokes[k].closed) continue;
    ends[strokes[k].from].push_back(k);
    ends[strokes[k].to].push_back(k);
  }
  for (std::size_t k = 0; k < strokes.size(); ++k) {
    if (strokes[k].closed) continue;
    for (const DrawnPoint& p : {strokes[k].to, strokes[k].from}) {
      const std::size_t count = ends[p].size();
      if (count == 1)
        throw InputError(strokes[k].place,
                         "an open path, which bounds nothing: no path continues from " + shown(p),
                         "a closed path, with Z at its end, or another path that begins there");
      if (count > 2)
        throw InputError(
            strokes[k].place,
            std::to_string(count) + " paths end at " + shown(p) + ", so the loops are ambiguous",
            "two ends at each point");
    }
  }
  return ends;
}

}  // namespace

std::vector<DrawnLoop> joined(std::vector<Stroke> strokes) {
  const Ends ends = ends_of(strokes);
  std::vector<DrawnLoop> loops;
  std::vector<bool> used(strokes.size(), false);
  for (std::size_t k = 0; k < strokes.size(); ++k) {
    if (used[k]) continue;
    DrawnLoop loop{std::move(strokes[k].chain), strokes[k].place};
    used[k] = true;
    if (!strokes[k].closed) {
      std::size_t last = k;
      for (DrawnPoint at = strokes[k].to; !(at == strokes[k].from);) {
        const std::vector<std::size_t>& two = ends.at(at);
        last = two[0] == last ? two[1] : two[0];
        used[last] = true;
        Stroke& next = strokes[last];
        const bool forwards = next.from == at;
        at = forwards ? next.to : next.from;
        if (!forwards) next.chain = table::shapes::reversed(std::move(next.chain));
        for (table::shapes::NamedCurve& piece : next.chain) loop.chain.push_back(std::move(piece));
      }
    }
    loops.push_back(std::move(loop));
  }
  return loops;
}

}  // namespace carom::files
