#include "client/commands/shared/shape_options.h"

#include <CLI/CLI.hpp>

#include "client/cli/value_checks.h"
#include "core/files/read/parse_shape.h"

namespace affskel::client {

std::string mesh_kinds() {
  std::vector<std::string_view> others = core::mesh_extensions();
  others.erase(others.begin());
  return "Geomview OFF," + core::listed(others) + ", also by gzip or zstd;\nvoxels in" +
         core::listed(core::voxel_extensions());
}

void add_file(CLI::App* command, const std::string& name, std::string& file, const std::string& what) {
  command->add_option(name, file, what)->required()->check(non_empty())->type_name("FILE");
}

void add_isovalue(CLI::App* command, std::optional<double>& isovalue) {
  command
      ->add_option_function<double>(
          "--isovalue", [&isovalue](double value) { isovalue = value; },
          "Of an image of voxels: the value at the surface of the solid")
      ->check(finite_number())
      ->type_name("V");
}

}  // namespace affskel::client
