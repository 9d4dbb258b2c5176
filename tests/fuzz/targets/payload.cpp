// SPDX-License-Identifier: Apache-2.0
// What stands behind HDF5 and the checksums: shapes, decoding and invariants. A mutant of a file hardly ever
// gets that far, because HDF5 protects its headers and the content hash our data. So the input is here a list
// of changes to a payload in memory, of all kinds, which then goes the way of a file that was loaded.
#include <algorithm>
#include <filesystem>
#include <iterator>

#include "fuzz/knead_target.h"
#include "load.h"
#include "schema.h"
#include "unit/formats/samples.h"
#include "unit/formats/session_sample.h"

namespace knead::fuzz {
namespace {

constexpr std::size_t kMaxBytes = std::size_t{1} << 20;  ///< of one value: keeps a run short

/// The input, read from the front; zeros when it is used up.
class Choices {
  public:
    Choices(const std::uint8_t* data, std::size_t size) : data_(data), size_(size) {}
    [[nodiscard]] bool any() const { return at_ < size_; }
    std::uint8_t byte() { return at_ < size_ ? data_[at_++] : std::uint8_t{0}; }
    /// Small numbers mostly, sometimes a huge one.
    std::uint64_t number() {
        const std::uint8_t first = byte();
        if (first < 0xf0) return first;
        std::uint64_t value = 0;
        for (int i = 0; i <= first - 0xf0 && i < 8; ++i)
            value = value << 8U | byte();
        return value;
    }
    std::size_t below(std::size_t n) { return n < 2 ? 0 : (std::size_t{byte()} << 8U | byte()) % n; }

  private:
    const std::uint8_t* data_;
    std::size_t size_;
    std::size_t at_ = 0;
};

Value copy_of_value(const Value& value) {
    Value copy;
    copy.type = value.type;
    copy.element_bytes = value.element_bytes;
    copy.extents = value.extents;
    copy.storage.assign(value.bytes.begin(), value.bytes.end());
    copy.bytes = copy.storage;
    return copy;
}

Node copy_of_node(const Node& node) {
    Node copy;
    copy.is_group = node.is_group;
    copy.value = copy_of_value(node.value);
    for (const auto& [name, value] : node.attributes)
        copy.attributes.emplace(name, copy_of_value(value));
    return copy;
}

Payload copy_of_payload(const Payload& payload) {
    Payload copy;
    for (const auto& [path, node] : payload.nodes)
        copy.nodes.emplace(path, copy_of_node(node));
    return copy;
}

/// One valid file of each kind.
std::vector<LoadedFile> load_samples() {
    const test::Folder folder;
    const auto file = folder / "sample.hdf";
    std::vector<LoadedFile> loaded;
    const auto add = [&](const Status& written) {
        expect(written.ok(), "a sample is written");
        loaded.push_back(load_file(file, small_limits(), kEveryKind));
    };
    add(write_tet_mesh(file, test::sample_mesh(), test::sample_provenance()));
    add(write_material(file, test::sample_material(), test::sample_provenance()));
    add(write_clustering(file, test::sample_clustering(), test::sample_provenance()));
    add(write_overlap(file, test::sample_overlap(), test::sample_provenance()));
    add(write_asset(file, test::sample_asset(), test::sample_provenance()));
    add(write_session_log(file, test::sample_session(), test::sample_provenance()));
    return loaded;
}

/// Makes the stored bytes as many as type and extents say, as a reader does before it loads; leaves out what
/// a reader refuses by its size.
void fit_storage(Value& value) {
    if (value.byte_count() > kMaxBytes) {
        value.extents = {1};
        value.element_bytes = size_of(value.type);
    }
    value.storage.resize(value.byte_count());
    value.bytes = value.storage;
}

void change_value(Choices& choices, Value& value) {
    switch (choices.byte() % 4) {
        case 0: {
            const std::size_t at = choices.below(value.storage.size());
            for (std::size_t i = 0, n = 1 + choices.byte() % 8; i < n && at + i < value.storage.size(); ++i)
                value.storage[at + i] = static_cast<std::byte>(choices.byte());
            break;
        }
        case 1: {
            value.extents.resize(choices.byte() % 5);
            for (std::uint64_t& extent : value.extents)
                extent = choices.number();
            break;
        }
        case 2:
            value.type = static_cast<ScalarType>(choices.byte() % 11);
            value.element_bytes = value.type == ScalarType::text ? 1 + choices.byte() : size_of(value.type);
            break;
        default:
            if (!value.extents.empty()) value.extents[choices.below(value.extents.size())] = choices.number();
    }
    fit_storage(value);
}

using Nodes = std::map<std::string, Node>;

Nodes::iterator pick(Choices& choices, Nodes& nodes) {
    return std::next(nodes.begin(), static_cast<std::ptrdiff_t>(choices.below(nodes.size())));
}

/// Without the node and what lies below it: a file has no other way.
void remove_tree(Nodes& nodes, const std::string& path) {
    for (auto node = nodes.begin(); node != nodes.end();)
        node = node->first == path || node->first.rfind(path + "/", 0) == 0 ? nodes.erase(node)
                                                                            : std::next(node);
}

std::string short_name(Choices& choices) {
    static const char* const kNames[] = {"000000", "000001", "999999", "regions", "names", "extra", "", "1"};
    return kNames[choices.byte() % std::size(kNames)];
}

void change(Choices& choices, Nodes& nodes) {
    if (nodes.empty()) return;
    const auto node = pick(choices, nodes);
    switch (choices.byte() % 6) {
        case 0:
        case 1:
            if (!node->second.is_group) change_value(choices, node->second.value);
            break;
        case 2:
            if (!node->second.attributes.empty()) {
                auto& attributes = node->second.attributes;
                const auto attribute = std::next(
                    attributes.begin(), static_cast<std::ptrdiff_t>(choices.below(attributes.size())));
                if (choices.byte() % 4 == 0)
                    attributes.erase(attribute);
                else
                    change_value(choices, attribute->second);
            }
            break;
        case 3:
            remove_tree(nodes, std::string(node->first));
            break;
        case 4: {
            const auto from = pick(choices, nodes);
            const std::string path = node->first + "/" + short_name(choices);
            if (node->second.is_group) nodes.emplace(path, copy_of_node(from->second));
            break;
        }
        default: {
            const auto from = pick(choices, nodes);
            if (!from->second.is_group && !node->second.is_group)
                node->second.value = copy_of_value(from->second.value);
        }
    }
}

void decode(FileKind kind, Schema& schema) {
    switch (kind) {
        case FileKind::tet_mesh:
            return (void)validate(take_tet_mesh(schema)).ok();
        case FileKind::material: {
            const TetMesh mesh = take_tet_mesh(schema);
            if (!validate(mesh).ok()) return;
            return (void)validate(take_material(schema), mesh.tetrahedra.size()).ok();
        }
        case FileKind::clustering: {
            const TetMesh mesh = take_tet_mesh(schema);
            if (!validate(mesh).ok()) return;
            (void)validate(take_material(schema), mesh.tetrahedra.size()).ok();
            return (void)validate(take_clustering(schema), mesh.tetrahedra.size()).ok();
        }
        case FileKind::overlap:
            return (void)validate(take_overlap(schema)).ok();
        case FileKind::asset:
            return (void)validate(take_asset(schema)).ok();
        case FileKind::session:
            return (void)validate(take_session(schema)).ok();
    }
}

}  // namespace
}  // namespace knead::fuzz

void knead::fuzz::read_hostile_file(const std::uint8_t* data, std::size_t size) {
    static const std::vector<LoadedFile> samples = fuzz::load_samples();
    static const ReadLimits limits = fuzz::small_limits();
    fuzz::Choices choices(data, size);
    const LoadedFile& sample = samples[choices.byte() % samples.size()];
    Payload payload = fuzz::copy_of_payload(sample.payload);
    Payload provenance = fuzz::copy_of_payload(sample.provenance);
    while (choices.any())
        fuzz::change(choices, choices.byte() % 5 == 0 ? provenance.nodes : payload.nodes);
    const Result<Unit> read = guarded("mutant", [&] {
        Schema described(provenance, "mutant", limits);
        check_provenance(described);
        described.refuse_unknown();
        (void)take_provenance(described);
        if (sample.header.kind == FileKind::asset) (void)take_requests(described);
        Schema schema(payload, "mutant", limits);
        check_shape(sample.header.kind, schema);
        schema.refuse_unknown();
        fuzz::decode(sample.header.kind, schema);
        return Unit{};
    });
    fuzz::expect_good_manners(read);
}
