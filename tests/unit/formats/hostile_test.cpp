// SPDX-License-Identifier: Apache-2.0
// One negative test for each code that a reader can return. Files are bent with HDF5 itself.
#include <gtest/gtest.h>
#include <hdf5.h>

#include <array>
#include <functional>

#include "samples.h"

namespace knead::test {
namespace {

/// A valid mesh file, changed by `bend` through HDF5. The content hash is not repaired.
class Hostile : public ::testing::Test {
  protected:
    void SetUp() override { ASSERT_TRUE(write_tet_mesh(file_, sample_mesh(), sample_provenance()).ok()); }

    void bend(const std::function<void(hid_t)>& change) {
        const hid_t file = H5Fopen(file_.c_str(), H5F_ACC_RDWR, H5P_DEFAULT);
        ASSERT_GE(file, 0);
        change(file);
        ASSERT_GE(H5Fclose(file), 0);
    }

    static void set_attribute(hid_t object, const char* name, hid_t type, const std::vector<hsize_t>& extents,
                              const void* data) {
        if (H5Aexists(object, name) > 0) H5Adelete(object, name);
        const hid_t space = extents.empty()
                                ? H5Screate(H5S_SCALAR)
                                : H5Screate_simple(static_cast<int>(extents.size()), extents.data(), nullptr);
        const hid_t attribute = H5Acreate2(object, name, type, space, H5P_DEFAULT, H5P_DEFAULT);
        ASSERT_GE(attribute, 0);
        if (data != nullptr) {
            ASSERT_GE(H5Awrite(attribute, type, data), 0);
        }
        H5Aclose(attribute);
        H5Sclose(space);
    }

    static hid_t text_type(std::size_t size) {
        const hid_t type = H5Tcopy(H5T_C_S1);
        H5Tset_size(type, size);
        return type;
    }

    /// Replaces a dataset by an empty one of another make.
    static hid_t replace_dataset(hid_t file, const char* path, hid_t type,
                                 const std::vector<hsize_t>& extents, hid_t creation = H5P_DEFAULT) {
        if (H5Lexists(file, path, H5P_DEFAULT) > 0) H5Ldelete(file, path, H5P_DEFAULT);
        const hid_t space = H5Screate_simple(static_cast<int>(extents.size()), extents.data(), nullptr);
        const hid_t dataset = H5Dcreate2(file, path, type, space, H5P_DEFAULT, creation, H5P_DEFAULT);
        EXPECT_GE(dataset, 0);
        set_attribute(dataset, "units", text_type(1), {}, "m");
        H5Sclose(space);
        return dataset;
    }

    Error error_of() {
        const Result<TetMesh> result = read_tet_mesh(file_);
        if (result.ok()) {
            ADD_FAILURE() << "the file was read";
            return {};
        }
        return result.error();
    }

    void expect(ErrorCode code, const std::string& part) {
        const Error error = error_of();
        EXPECT_EQ(static_cast<int>(error.code), static_cast<int>(code)) << error.text();
        EXPECT_NE(error.text().find(part), std::string::npos) << error.text();
    }

    Folder folder_;
    std::filesystem::path file_ = folder_ / "mesh.hdf";
};

TEST_F(Hostile, A_file_that_is_not_there_gives_io_error) {
    std::filesystem::remove(file_);
    expect(ErrorCode::io_error, "mesh.hdf");
}

TEST_F(Hostile, A_folder_gives_io_error) {
    std::filesystem::remove(file_);
    std::filesystem::create_directory(file_);
    expect(ErrorCode::io_error, "mesh.hdf");
}

TEST_F(Hostile, A_text_file_gives_not_knead) {
    put_bytes(file_, {'M', 'e', 's', 'h', '\n'});
    expect(ErrorCode::not_knead, "not an HDF5 file");
}

TEST_F(Hostile, An_empty_file_gives_not_knead) {
    put_bytes(file_, {});
    expect(ErrorCode::not_knead, "not an HDF5 file");
}

TEST_F(Hostile, HDF5_of_another_program_gives_not_knead) {
    H5Fclose(H5Fcreate(file_.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT));
    expect(ErrorCode::not_knead, "not one of Knead");
}

TEST_F(Hostile, A_format_attribute_of_another_program_gives_not_knead) {
    bend([](hid_t file) {
        const double number = 1;
        set_attribute(file, "format", H5T_NATIVE_DOUBLE, {}, &number);
    });
    expect(ErrorCode::not_knead, "not one of Knead");
}

TEST_F(Hostile, A_newer_major_version_gives_version_unsupported) {
    bend([](hid_t file) {
        const std::array<std::int32_t, 2> version{2, 0};
        set_attribute(file, "format_version", H5T_STD_I32LE, {2}, version.data());
    });
    expect(ErrorCode::version_unsupported, "2.0");
}

TEST_F(Hostile, A_newer_minor_version_is_read) {
    bend([](hid_t file) {
        const std::array<std::int32_t, 2> version{1, 9};
        set_attribute(file, "format_version", H5T_STD_I32LE, {2}, version.data());
    });
    EXPECT_TRUE(read_tet_mesh(file_).ok());
}

TEST_F(Hostile, An_unknown_required_feature_gives_feature_unsupported_and_is_named) {
    bend([](hid_t file) { set_attribute(file, "required_features", text_type(9), {1}, "hexahedra"); });
    expect(ErrorCode::feature_unsupported, "hexahedra");
}

TEST_F(Hostile, Another_kind_gives_wrong_kind) {
    ASSERT_TRUE(write_overlap(file_, sample_overlap(), {}).ok());
    expect(ErrorCode::wrong_kind, "overlap");
}

TEST_F(Hostile, An_unknown_kind_gives_wrong_kind) {
    bend([](hid_t file) { set_attribute(file, "kind", text_type(4), {}, "hexa"); });
    expect(ErrorCode::wrong_kind, "hexa");
}

TEST_F(Hostile, A_dataset_taken_away_gives_missing) {
    bend([](hid_t file) { H5Ldelete(file, "/knead/mesh/nodes_m", H5P_DEFAULT); });
    expect(ErrorCode::missing, "/knead/mesh/nodes_m");
}

TEST_F(Hostile, A_root_attribute_taken_away_gives_missing) {
    bend([](hid_t file) { H5Adelete(file, "content_hash"); });
    expect(ErrorCode::missing, "content_hash");
}

TEST_F(Hostile, No_payload_gives_missing) {
    bend([](hid_t file) { H5Ldelete(file, "/knead", H5P_DEFAULT); });
    expect(ErrorCode::missing, "#/knead");
}

TEST_F(Hostile, Units_taken_away_give_missing) {
    bend([](hid_t file) { H5Adelete_by_name(file, "/knead/mesh/nodes_m", "units", H5P_DEFAULT); });
    expect(ErrorCode::missing, "units");
}

TEST_F(Hostile, Other_units_give_invalid_data) {
    bend([](hid_t file) {
        const hid_t dataset = H5Dopen2(file, "/knead/mesh/nodes_m", H5P_DEFAULT);
        set_attribute(dataset, "units", text_type(2), {}, "mm");
        H5Dclose(dataset);
    });
    expect(ErrorCode::invalid_data, "\"mm\" instead of \"m\"");
}

TEST_F(Hostile, Every_other_number_type_gives_wrong_type) {
    for (const hid_t type : {H5T_STD_I64LE, H5T_IEEE_F32LE, H5T_IEEE_F64BE, H5T_STD_U8LE, H5T_STD_B64LE}) {
        bend([&](hid_t file) { H5Dclose(replace_dataset(file, "/knead/mesh/nodes_m", type, {8, 3})); });
        expect(ErrorCode::wrong_type, "/knead/mesh/nodes_m");
    }
}

TEST_F(Hostile, Text_of_variable_length_gives_wrong_type) {
    bend([](hid_t file) {
        H5Dclose(replace_dataset(file, "/knead/mesh/regions/names", text_type(H5T_VARIABLE), {2}));
    });
    expect(ErrorCode::wrong_type, "variable length");
}

TEST_F(Hostile, A_group_where_a_dataset_belongs_gives_wrong_type) {
    bend([](hid_t file) {
        H5Ldelete(file, "/knead/mesh/nodes_m", H5P_DEFAULT);
        H5Gclose(H5Gcreate2(file, "/knead/mesh/nodes_m", H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT));
    });
    expect(ErrorCode::wrong_type, "is a group");
}

TEST_F(Hostile, Another_rank_gives_wrong_extent) {
    const std::vector<double> zeros(24);
    bend([&](hid_t file) {
        const hid_t dataset = replace_dataset(file, "/knead/mesh/nodes_m", H5T_IEEE_F64LE, {24});
        H5Dwrite(dataset, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, zeros.data());
        H5Dclose(dataset);
    });
    expect(ErrorCode::wrong_extent, "[24], not [any, 3]");
}

TEST_F(Hostile, A_small_file_that_declares_huge_extents_gives_too_large) {
    bend([](hid_t file) {
        const hid_t creation = H5Pcreate(H5P_DATASET_CREATE);
        const std::array<hsize_t, 2> chunk{1024, 3};
        H5Pset_chunk(creation, 2, chunk.data());
        H5Dclose(
            replace_dataset(file, "/knead/mesh/nodes_m", H5T_IEEE_F64LE, {hsize_t{1} << 40, 3}, creation));
        H5Pclose(creation);
    });
    expect(ErrorCode::too_large, "/knead/mesh/nodes_m");
}

TEST_F(Hostile, Extents_that_are_not_stored_give_too_large) {
    bend([](hid_t file) {
        const hid_t creation = H5Pcreate(H5P_DATASET_CREATE);
        const std::array<hsize_t, 2> chunk{1024, 3};
        H5Pset_chunk(creation, 2, chunk.data());
        H5Dclose(replace_dataset(file, "/knead/mesh/nodes_m", H5T_IEEE_F64LE, {1'000'000, 3}, creation));
        H5Pclose(creation);
    });
    expect(ErrorCode::too_large, "too small to hold");
}

TEST_F(Hostile, A_mesh_beyond_the_limits_gives_too_large) {
    ReadLimits limits;
    limits.max_tetrahedra = 5;
    EXPECT_EQ(read_tet_mesh(file_, limits).error().code, ErrorCode::too_large);
    limits = {};
    limits.max_bytes = 100;
    EXPECT_EQ(read_tet_mesh(file_, limits).error().code, ErrorCode::too_large);
    limits = {};
    limits.max_names = 1;
    EXPECT_EQ(read_tet_mesh(file_, limits).error().code, ErrorCode::too_large);
}

TEST_F(Hostile, A_soft_link_gives_forbidden) {
    bend([](hid_t file) {
        H5Ldelete(file, "/knead/mesh/nodes_m", H5P_DEFAULT);
        H5Lcreate_soft("/VTKHDF/Points", file, "/knead/mesh/nodes_m", H5P_DEFAULT, H5P_DEFAULT);
    });
    expect(ErrorCode::forbidden, "soft or external link");
}

TEST_F(Hostile, A_soft_link_as_a_group_on_the_way_gives_forbidden) {
    bend([](hid_t file) {
        H5Lmove(file, "/knead", file, "/elsewhere", H5P_DEFAULT, H5P_DEFAULT);
        H5Lcreate_soft("/elsewhere", file, "/knead", H5P_DEFAULT, H5P_DEFAULT);
    });
    expect(ErrorCode::forbidden, "#/knead");
}

TEST_F(Hostile, An_external_link_gives_forbidden) {
    const auto other = folder_ / "other.hdf";
    std::filesystem::copy_file(file_, other);
    bend([&](hid_t file) {
        H5Ldelete(file, "/knead/mesh/nodes_m", H5P_DEFAULT);
        H5Lcreate_external(other.c_str(), "/knead/mesh/nodes_m", file, "/knead/mesh/nodes_m", H5P_DEFAULT,
                           H5P_DEFAULT);
    });
    expect(ErrorCode::forbidden, "soft or external link");
}

TEST_F(Hostile, External_storage_gives_forbidden) {
    const auto other = folder_ / "raw.bin";
    put_bytes(other, std::vector<char>(192));
    bend([&](hid_t file) {
        const hid_t creation = H5Pcreate(H5P_DATASET_CREATE);
        H5Pset_external(creation, other.c_str(), 0, 192);
        H5Dclose(replace_dataset(file, "/knead/mesh/nodes_m", H5T_IEEE_F64LE, {8, 3}, creation));
        H5Pclose(creation);
    });
    expect(ErrorCode::forbidden, "another file");
}

TEST_F(Hostile, A_virtual_dataset_gives_forbidden) {
    bend([&](hid_t file) {
        const hid_t creation = H5Pcreate(H5P_DATASET_CREATE);
        const std::array<hsize_t, 2> extents{8, 3};
        const hid_t space = H5Screate_simple(2, extents.data(), nullptr);
        H5Pset_virtual(creation, space, "/etc/other.hdf", "/data", space);
        H5Dclose(replace_dataset(file, "/knead/mesh/nodes_m", H5T_IEEE_F64LE, {8, 3}, creation));
        H5Sclose(space);
        H5Pclose(creation);
    });
    expect(ErrorCode::forbidden, "virtual");
}

TEST_F(Hostile, Another_filter_gives_forbidden) {
    bend([&](hid_t file) {
        const hid_t creation = H5Pcreate(H5P_DATASET_CREATE);
        const std::array<hsize_t, 2> chunk{8, 3};
        H5Pset_chunk(creation, 2, chunk.data());
        H5Pset_scaleoffset(creation, H5Z_SO_FLOAT_DSCALE, 3);
        H5Dclose(replace_dataset(file, "/knead/mesh/nodes_m", H5T_IEEE_F64LE, {8, 3}, creation));
        H5Pclose(creation);
    });
    expect(ErrorCode::forbidden, "filter 6");
}

TEST_F(Hostile, A_second_name_of_an_object_gives_forbidden) {
    bend([](hid_t file) {
        H5Lcreate_hard(file, "/knead", file, "/knead/mesh/loop", H5P_DEFAULT, H5P_DEFAULT);
    });
    expect(ErrorCode::forbidden, "another name");
}

TEST_F(Hostile, Edited_values_give_corrupt) {
    bend([](hid_t file) {
        const hid_t dataset = H5Dopen2(file, "/knead/mesh/nodes_m", H5P_DEFAULT);
        std::vector<double> nodes(24);
        H5Dread(dataset, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, nodes.data());
        nodes[5] += 1e-12;
        H5Dwrite(dataset, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, nodes.data());
        H5Dclose(dataset);
    });
    expect(ErrorCode::corrupt, "hash");
}

TEST_F(Hostile, A_file_cut_in_half_gives_corrupt) {
    std::vector<char> bytes = bytes_of(file_);
    bytes.resize(bytes.size() / 2);
    put_bytes(file_, bytes);
    expect(ErrorCode::corrupt, "truncated");
}

TEST_F(Hostile, A_dataset_that_does_not_belong_gives_invalid_data) {
    bend([](hid_t file) { H5Dclose(replace_dataset(file, "/knead/mesh/extra", H5T_IEEE_F64LE, {0})); });
    expect(ErrorCode::invalid_data, "/knead/mesh/extra");
}

TEST_F(Hostile, A_dataset_added_by_a_newer_minor_version_is_covered_by_the_hash_only) {
    bend([](hid_t file) {
        const std::array<std::int32_t, 2> version{1, 9};
        set_attribute(file, "format_version", H5T_STD_I32LE, {2}, version.data());
        H5Dclose(replace_dataset(file, "/knead/mesh/extra", H5T_IEEE_F64LE, {0}));
    });
    expect(ErrorCode::corrupt, "hash");  // not repaired by bend(): the addition itself was accepted
}

/// The same for an asset; its third tool is a capsule with friction.
class Hostile_asset : public Hostile {
  protected:
    void SetUp() override {
        file_ = folder_ / "asset.hdf";
        ASSERT_TRUE(write_asset(file_, sample_asset(), sample_provenance()).ok());
    }

    void expect_refused(ErrorCode code, const std::string& part) {
        const Result<Asset> result = read_asset(file_);
        ASSERT_FALSE(result.ok());
        EXPECT_EQ(static_cast<int>(result.error().code), static_cast<int>(code)) << result.error().text();
        EXPECT_NE(result.error().text().find(part), std::string::npos) << result.error().text();
    }

    void set_text(const char* object, const char* name, const std::string& text) {
        bend([&](hid_t file) {
            const hid_t group = H5Oopen(file, object, H5P_DEFAULT);
            set_attribute(group, name, text_type(text.size()), {}, text.data());
            H5Oclose(group);
        });
    }
};

TEST_F(Hostile_asset, A_shape_or_contact_that_does_not_exist_gives_invalid_data) {
    set_text("/knead/asset/tools/000001", "shape", "torus");
    expect_refused(ErrorCode::invalid_data, "asset.hdf#/knead/asset/tools/000001@shape");
    set_text("/knead/asset/tools/000001", "shape", "sphere");
    set_text("/knead/asset/tools/000001", "contact", "glued");
    expect_refused(ErrorCode::invalid_data, "\"glued\" is not a contact");
}

TEST_F(Hostile_asset, A_shape_or_contact_without_its_numbers_gives_missing) {
    set_text("/knead/asset/tools/000001", "shape", "capsule");
    expect_refused(ErrorCode::missing, "/tools/000001/half_length_m");
    set_text("/knead/asset/tools/000001", "shape", "plate");
    expect_refused(ErrorCode::missing, "/tools/000001/half_extents_m");
    set_text("/knead/asset/tools/000001", "shape", "sphere");
    set_text("/knead/asset/tools/000001", "contact", "coulomb");
    expect_refused(ErrorCode::missing, "/tools/000001/friction_coefficient");
}

TEST_F(Hostile_asset, Numbers_of_another_shape_or_contact_give_invalid_data) {
    set_text("/knead/asset/tools/000002", "shape", "sphere");
    expect_refused(ErrorCode::invalid_data, "/tools/000002/half_length_m: does not belong");
    set_text("/knead/asset/tools/000002", "shape", "capsule");
    set_text("/knead/asset/tools/000002", "contact", "sticking");
    expect_refused(ErrorCode::invalid_data, "/tools/000002/friction_coefficient: does not belong");
}

TEST_F(Hostile_asset, An_embedding_of_other_types_or_extents_is_refused_with_its_place) {
    const std::string group = "/knead/asset/embedding/";
    const auto replaced = [&](const char* name, hid_t type, const std::vector<hsize_t>& extents,
                              ErrorCode code, const std::string& part) {
        ASSERT_TRUE(write_asset(file_, sample_asset(), {}).ok());
        bend([&](hid_t file) {
            const hid_t dataset = replace_dataset(file, (group + name).c_str(), type, extents);
            set_attribute(dataset, "units", text_type(1), {}, "1");
            H5Dclose(dataset);
        });
        expect_refused(code, part);
    };
    replaced("weights", H5T_IEEE_F64LE, {3, 4}, ErrorCode::wrong_type, "embedding/weights");
    replaced("weights", H5T_IEEE_F32LE, {2, 4}, ErrorCode::wrong_extent, "[2, 4], not [3, 4]");
    replaced("weights", H5T_IEEE_F32LE, {3, 3}, ErrorCode::wrong_extent, "embedding/weights");
    replaced("tetrahedron", H5T_STD_I32LE, {3}, ErrorCode::wrong_type, "embedding/tetrahedron");
    replaced("triangles", H5T_STD_U32LE, {6}, ErrorCode::wrong_extent, "embedding/triangles");
    replaced("still_vertices_m", H5T_IEEE_F64LE, {1, 3}, ErrorCode::invalid_data, "instead of \"m\"");
    replaced("extra", H5T_STD_U32LE, {6}, ErrorCode::invalid_data, "embedding/extra: does not belong");
    ReadLimits limits;
    limits.max_nodes = 8;
    ASSERT_TRUE(write_asset(file_, sample_asset(), {}).ok());
    EXPECT_TRUE(read_asset(file_, limits).ok());
    Asset asset = sample_asset();
    asset.embedding.still_vertices_m.assign(6, {});
    ASSERT_TRUE(write_asset(file_, asset, {}).ok());
    EXPECT_EQ(read_asset(file_, limits).error().code, ErrorCode::too_large);
    bend([&](hid_t file) { H5Ldelete(file, (group + "triangles").c_str(), H5P_DEFAULT); });
    expect_refused(ErrorCode::missing, "embedding/triangles");
}

TEST_F(Hostile_asset, Names_the_features_that_older_readers_lack_and_no_others) {
    using Names = std::vector<std::string>;
    EXPECT_EQ(read_header(file_).value().required_features, (Names{"capsule_tool", "coulomb_contact"}));
    Asset asset = sample_asset();
    asset.tools[2].contact = ToolContact::sticking;
    ASSERT_TRUE(write_asset(file_, asset, {}).ok());
    EXPECT_EQ(read_header(file_).value().required_features, Names{"capsule_tool"});
    asset.tools.pop_back();
    ASSERT_TRUE(write_asset(file_, asset, {}).ok());
    EXPECT_EQ(read_header(file_).value().required_features, Names{});
}

TEST_F(Hostile, Whatever_was_read_leaves_the_printing_of_HDF5_as_it_was) {
    H5E_auto2_t before = nullptr, after = nullptr;
    void* data = nullptr;
    H5Eget_auto2(H5E_DEFAULT, &before, &data);
    unsigned plugins = 0, plugins_after = 0;
    H5PLget_loading_state(&plugins);
    put_bytes(file_, {'x'});
    (void)error_of();
    ASSERT_TRUE(write_tet_mesh(file_, sample_mesh(), {}).ok());
    (void)read_tet_mesh(file_).ok();
    H5Eget_auto2(H5E_DEFAULT, &after, &data);
    H5PLget_loading_state(&plugins_after);
    EXPECT_EQ(before, after);
    EXPECT_EQ(plugins, plugins_after);
}

}  // namespace
}  // namespace knead::test
