#include "io/starts_file.hpp"

#include <utility>

#include "io/number_lines.hpp"
#include "io/section.hpp"

namespace carom::io {

void take_starts_from_file(Value& initial) {
  const Value* kind = initial.find("kind");
  if (kind == nullptr || kind->text != "file") return;
  Section section(initial, "initial", "file");
  section.check_keys();
  const Value& path = section.get("path");
  as_text(path);
  Value starts = rows_of_file(located(path), path.place, {"start", "x y vx vy", 4, 4});
  initial.find("kind")->text = "list";
  initial.erase("path");
  initial.set("starts", std::move(starts));
}

}  // namespace carom::io
