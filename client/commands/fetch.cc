#include <CLI/CLI.hpp>
#include <memory>

#include "client/cli/value_checks.h"
#include "client/commands/commands.h"
#include "client/commands/shared/destination.h"
#include "client/commands/shared/job_options.h"
#include "client/commands/shared/written.h"
#include "client/text/words.h"
#include "wire/params.h"

namespace affskel::client {
namespace {

struct FetchOptions {
  std::string job, artifact, output, format;
  SkeletonChoice skeleton;  // the operator of the divergence alone, the threshold of limbs
  bool parts = false;       // of the field alone
};

void run_fetch(Context& context, const FetchOptions& options) {
  const Destination destination = destination_of(options.output, options.format, context.console());
  FetchRequest request{options.job, options.artifact, destination, options.skeleton};
  request.parts = options.parts;
  show_result(context.console(), fetch(context.session(), request));
}

// FetchOptions that only some artefacts have.
void check_options(const CLI::App& fetch) {
  const std::string artifact = fetch.get_option("ARTEFACT")->as<std::string>();
  if (fetch.count("--operator") > 0 && artifact != "divergence") {
    throw CLI::ValidationError("--operator", "is for the divergence");
  }
  if (fetch.count("--threshold") > 0 && artifact != "curve" && artifact != "thickness")
    throw CLI::ValidationError("--threshold", "is for the curve and the thickness");
  if (fetch.count("--parts") > 0 && artifact != "field")
    throw CLI::ValidationError("--parts", "is for the field; files of surfaces have parts anyway");
}

}  // namespace

void add_fetch(CommandLine& line) {
  const auto options = std::make_shared<FetchOptions>();
  CLI::App* command = line.add(
      "fetch", "Write one artefact of a job",
      "  affskel-client fetch @last field -o body.vti\n"
      "  affskel-client fetch @last skeleton -o body.csv\n"
      "  affskel-client fetch @last curve -o limbs.json\n"
      "  affskel-client fetch @last curve --threshold 3 -o long.swc\n"
      "  affskel-client fetch @last thickness -o thickness.ply\n"
      "  affskel-client fetch 3f2a9c mesh -o submitted.off\n"
      "  affskel-client fetch @last divergence --operator sobel -o H.csv\n"
      "  affskel-client fetch @last skeleton -o - --format csv | wc -l\n"
      "Formats by extension: field and divergence .csv .dat .vti .vts .vtkhdf .hdf;\n"
      "skeleton, surface, eroded and mesh .vtp .ply .obj .stl .off, where the mesh as\n"
      ".off is the submitted bytes; points of skeleton and eroded .csv .xyz;\n"
      "curve .vtp .obj .ply, as a graph .json .graphml, as trees .swc, as joints that\n"
      "move the mesh .glb, as vertices .csv .xyz; thickness, of each triangle with the\n"
      "part of the solid that it belongs to, .ply .vtp.\n"
      ".vti and .vts open in every ParaView, .vts also where the lattice is turned.\n"
      "Of an eroded solid this is the one at a tenth of the volume; see erode",
      [options](Context& context) { run_fetch(context, *options); }, check_options);
  add_job(command, options->job);
  command->add_option("ARTEFACT", options->artifact, "What to fetch")
      ->required()
      ->check(one_of(artifact_names()))
      ->type_name("");
  std::vector<std::string> with_divergence = operator_words();
  std::erase_if(with_divergence,
                [](const std::string& name) { return wire::gives_sheet(operator_named(name)); });
  command->add_option("--operator", options->skeleton.operator_name, "Of the divergence (default: the job's)")
      ->check(one_of(with_divergence))
      ->type_name("OP");
  command
      ->add_option(
          "--threshold", options->skeleton.threshold,
          "Of the curve, and of the parts beside the thickness: the shortest limb\n"
          "that counts, in its own radii (default: 0.9, of the curve the job's where its\noperator is curve)")
      ->check(positive_number())
      ->type_name("T");
  command->add_flag(
      "--parts", options->parts,
      "The field with the part of the solid (see measure) that each sample\npoint lies in; not as .dat");
  add_output(command, options->output, "File to write; the format follows the extension; - is stdout");
  add_format(command, options->format);
}

}  // namespace affskel::client
