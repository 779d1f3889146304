#include "core/files/read/vtp_description.h"

#include <optional>
#include <utility>

#include "base/number_text.h"
#include "core/files/read/xml_reader.h"
#include "core/text/text_rows.h"

namespace affskel::core {
namespace {

class DescriptionReader : public XmlHandler {
 public:
  explicit DescriptionReader(std::string_view bytes) : bytes_(bytes) {}

  VtpDescription run() {
    switch (read_xml(bytes_, *this)) {
      case XmlEnd::kNoElement:
        fail_at(1, "not a VTK XML file");
      case XmlEnd::kCutOff:
        if (array_) fail_at(array_->line, "the element of an array does not end");
        fail_at(last_line_, "the file ends without </VTKFile>");
      case XmlEnd::kComplete:
      case XmlEnd::kStopped:
        break;
    }
    return std::move(description_);
  }

  Next open(const XmlElement& element) override {
    const bool first = last_line_ == 0;
    last_line_ = element.line;
    if (first) {
      read_head(element);
    } else if (array_) {
      ++array_depth_;
    } else if (element.name == "AppendedData") {
      read_appended(element);
      return Next::kStop;
    } else if (element.name == "Piece") {
      begin_piece(element);
    } else if (element.name == "DataArray" || element.name == "Array") {
      begin_array(element);
    } else {
      section_ = element.name;
    }
    return Next::kReadOn;
  }

  Next close(std::string_view name, std::uint64_t line) override {
    last_line_ = line;
    if (array_ && array_depth_ > 0) {
      --array_depth_;
    } else if (array_) {
      end_array();
    } else {
      section_.clear();
    }
    return name == "VTKFile" ? Next::kStop : Next::kReadOn;
  }

  // Elements within an array describe it; their text is not its own.
  void text(std::string_view text, bool stays) override {
    if (!array_ || array_depth_ > 0) return;
    if (!copied_ && stays && (text_.empty() || text_.data() + text_.size() == text.data())) {
      text_ = text_.empty() ? text : std::string_view(text_.data(), text_.size() + text.size());
      return;
    }
    if (!copied_) copied_ = &description_.texts.emplace_back(text_);
    *copied_ += text;
  }

 private:
  void read_head(const XmlElement& element) {
    if (element.name != "VTKFile")
      fail_at(element.line, "is XML of the kind " + quoted_excerpt(element.name) +
                                ", not VTK's; export it as .off, .ply, .obj, .stl or .glb");
    if (element.attribute("type") != "PolyData") {
      fail_at(element.line,
              "a VTK file of type " + quoted_excerpt(element.attribute("type")) + "; only PolyData is read");
    }
    description_.encoding.big_endian = element.attribute("byte_order") == "BigEndian";
    description_.encoding.long_headers = element.attribute("header_type") == "UInt64";
    description_.encoding.compressor = element.attribute("compressor");
  }

  void read_appended(const XmlElement& element) {
    description_.encoding.base64 = element.attribute("encoding") == "base64";
    const std::size_t mark = bytes_.find('_', element.end);
    if (mark == std::string_view::npos) fail_at(element.line, "the appended data do not begin with '_'");
    std::string_view& appended = description_.encoding.appended;
    appended = bytes_.substr(mark + 1);
    if (description_.encoding.base64) appended = appended.substr(0, appended.find('<'));
  }

  void begin_piece(const XmlElement& element) {
    VtpPiece piece{{}, {}, element.line};
    for (const char* what : {"Points", "Verts", "Lines", "Strips", "Polys"}) {
      const std::string name = std::string("NumberOf") + what;
      const std::string count = element.attribute(name);
      if (!count.empty()) piece.announced[what] = parse_count(count, element.line, name.c_str());
    }
    description_.pieces.push_back(std::move(piece));
  }

  void begin_array(const XmlElement& element) {
    array_ = VtkArray{element.attribute("Name"),
                      element.attribute("type"),
                      element.attribute("format"),
                      element.attribute("offset"),
                      1,
                      {},
                      element.line};
    const std::string components = element.attribute("NumberOfComponents");
    if (!components.empty()) {
      array_->components = parse_count(components, element.line, "NumberOfComponents");
    }
    array_depth_ = 0;
    text_ = {};
    copied_ = nullptr;
  }

  void end_array() {
    array_->text = copied_ != nullptr ? std::string_view(*copied_) : text_;
    if (!description_.pieces.empty() && !section_.empty()) {
      description_.pieces.back().arrays[section_].push_back(std::move(*array_));
    }
    array_.reset();
  }

  std::string_view bytes_;
  std::string section_;
  std::uint64_t last_line_ = 0;  // of the last tag
  std::optional<VtkArray> array_;
  std::size_t array_depth_ = 0;    // of elements within it
  std::string_view text_;          // of the array, while it stands in the file in one piece
  std::string* copied_ = nullptr;  // of the array, from then on
  VtpDescription description_;
};

}  // namespace

VtpDescription read_vtp_description(std::string_view bytes) {
  return DescriptionReader(bytes).run();
}

}  // namespace affskel::core
