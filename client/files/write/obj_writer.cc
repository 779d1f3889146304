#include "base/number_text.h"
#include "client/files/write/shape_writers.h"
#include "client/text/printable.h"
#include "core/files/numbers.h"

namespace affskel::client {

void write_obj(const core::Mesh& mesh, const std::vector<std::string>& comments, const WriteBytes& write) {
  std::string text;
  for (const std::string& comment : comments) text += "# " + one_line(comment) + "\n";
  write(text);
  for (const core::Vec3& p : mesh.points) {
    write("v " + base::to_text(p.x) + " " + base::to_text(p.y) + " " + base::to_text(p.z) + "\n");
  }
  for (const core::Triangle& t : mesh.triangles) {
    text = "f";
    for (const std::uint32_t corner : t) {
      text.push_back(' ');
      core::append_integer(text, std::uint64_t{corner} + 1);
    }
    write(text + "\n");
  }
}

}  // namespace affskel::client
