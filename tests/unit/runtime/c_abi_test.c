/* SPDX-License-Identifier: Apache-2.0 */
/* c_abi_test ASSET: the C interface, compiled as C. Says what failed; exit status 0 if nothing did. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "knead/knead.h"

static int failures = 0;

#define CHECK(condition)                                                      \
    do {                                                                      \
        if (!(condition)) {                                                   \
            fprintf(stderr, "line %d: not true: %s\n", __LINE__, #condition); \
            ++failures;                                                       \
        }                                                                     \
    } while (0)

static void check_names(void) {
    CHECK(strcmp(knead_error_name(KNEAD_OK), "ok") == 0);
    CHECK(strcmp(knead_error_name(KNEAD_ERROR_INVALID_DATA), "invalid_data") == 0);
    CHECK(strcmp(knead_error_name(KNEAD_ERROR_INVALID_ARGUMENT), "invalid_argument") == 0);
    CHECK(strcmp(knead_error_name((knead_error)99), "unknown") == 0);
    CHECK(strcmp(knead_step_status_name(0), "ok") == 0);
    CHECK(strcmp(knead_step_status_name(KNEAD_STEP_BAD_INPUT), "bad_input") == 0);
    CHECK(strcmp(knead_step_status_name(KNEAD_STEP_INSIDE_OUT), "inside_out") == 0);
    CHECK(strcmp(knead_step_status_name(1u << 30), "unknown") == 0);
    CHECK(knead_version()[0] != '\0');
}

static void check_failed_loads(const char* asset) {
    knead_simulation* simulation = (knead_simulation*)&failures;
    const size_t seventh = 7;
    knead_config config;
    CHECK(knead_simulation_load("/nowhere/at/all.hdf", NULL, &simulation) == KNEAD_ERROR_IO);
    CHECK(simulation == NULL);
    CHECK(strstr(knead_last_error(NULL), "all.hdf") != NULL);
    CHECK(knead_simulation_load(NULL, NULL, &simulation) == KNEAD_ERROR_INVALID_ARGUMENT);
    CHECK(knead_simulation_load(asset, NULL, NULL) == KNEAD_ERROR_INVALID_ARGUMENT);
    memset(&config, 0, sizeof config);
    CHECK(knead_simulation_load(asset, &config, &simulation) == KNEAD_ERROR_INVALID_ARGUMENT);
    CHECK(strstr(knead_last_error(NULL), "struct_size") != NULL);
    knead_config_init(&config);
    config.tools = &seventh;
    config.tool_count = 1;
    CHECK(knead_simulation_load(asset, &config, &simulation) == KNEAD_ERROR_INVALID_ARGUMENT);
    CHECK(strstr(knead_last_error(NULL), "tool") != NULL);
    config.tools = NULL;
    CHECK(knead_simulation_load(asset, &config, &simulation) == KNEAD_ERROR_INVALID_ARGUMENT);
    CHECK(strstr(knead_last_error(NULL), "tool_count") != NULL);
    knead_config_init(&config);
    config.arithmetic = 7;
    CHECK(knead_simulation_load(asset, &config, &simulation) == KNEAD_ERROR_INVALID_ARGUMENT);
    CHECK(strstr(knead_last_error(NULL), "arithmetic") != NULL);
}

static void check_press(const char* asset) {
    knead_simulation* simulation = NULL;
    knead_step_result result;
    knead_pose pose;
    double* const position = pose.position_m;
    int i;
    if (knead_simulation_load(asset, NULL, &simulation) != KNEAD_OK) {
        fprintf(stderr, "%s\n", knead_last_error(NULL));
        ++failures;
        return;
    }
    CHECK(knead_last_error(NULL)[0] == '\0');
    CHECK(knead_simulation_node_count(simulation) == 343);
    CHECK(knead_simulation_tetrahedron_count(simulation) > 1000);
    CHECK(knead_simulation_rest_pose(simulation, 0, &pose) == KNEAD_OK);
    knead_step_result_init(&result);
    for (i = 1; i <= 300; ++i) {
        position[2] = 0.1 - 0.01 * (i < 50 ? i / 50.0 : 1.0);
        CHECK(knead_simulation_step(simulation, position, i % 2 ? pose.orientation_wxyz : NULL, 20e-3,
                                    &result) == KNEAD_OK);
        CHECK(result.status == 0);
    }
    CHECK(fabs(result.force_n[2] - 23.82645) < 1e-3 * 23.82645);
    CHECK(result.touched_nodes == 49);
    CHECK(knead_simulation_positions_m(simulation)[0] >= -0.1);
    CHECK(knead_simulation_step(simulation, NULL, NULL, 1e-3, &result) == KNEAD_ERROR_INVALID_ARGUMENT);
    CHECK(strstr(knead_last_error(simulation), "position_m") != NULL);
    result.struct_size = 0;
    CHECK(knead_simulation_step(simulation, position, NULL, 1e-3, &result) == KNEAD_ERROR_INVALID_ARGUMENT);
    knead_step_result_init(&result);
    CHECK(knead_simulation_step(simulation, position, NULL, 1.0, &result) == KNEAD_OK);
    CHECK(result.status == KNEAD_STEP_BAD_INPUT && result.force_n[2] == 0);
    CHECK(knead_simulation_reset(simulation) == KNEAD_OK);
    position[2] = 0.1;
    CHECK(knead_simulation_step(simulation, position, NULL, 1e-3, &result) == KNEAD_OK);
    CHECK(fabs(result.force_n[2]) < 1e-9);
    knead_simulation_free(simulation);
}

/* Torque, the local model, and a caller whose struct is of a later version. */
static void check_what_is_asked_for(const char* asset) {
    const size_t first = 0;
    knead_simulation* simulation = NULL;
    knead_config config;
    knead_pose pose;
    knead_local_model model;
    struct {
        knead_step_result result;
        double later;
    } newer;
    int i;
    knead_config_init(&config);
    config.tools = &first;
    config.tool_count = 1;
    config.with_torque = 1;
    config.with_local_model = 1;
    config.arithmetic = KNEAD_ARITHMETIC_FLOAT64;
    config.expected_dt_s = 5e-3;
    CHECK(knead_simulation_load(asset, &config, &simulation) == KNEAD_OK);
    if (simulation == NULL) return;
    CHECK(knead_simulation_tool_count(simulation) == 1);
    CHECK(knead_simulation_rest_pose(simulation, 0, &pose) == KNEAD_OK);
    CHECK(knead_simulation_rest_pose(simulation, 1, &pose) == KNEAD_ERROR_INVALID_ARGUMENT);
    knead_local_model_init(&model);
    CHECK(knead_simulation_local_model(simulation, 0, &model) == KNEAD_ERROR_INVALID_ARGUMENT);
    CHECK(strstr(knead_last_error(simulation), "no step") != NULL);
    memset(&newer, 0, sizeof newer);
    newer.result.struct_size = sizeof newer;
    newer.later = 42;
    pose.position_m[0] += 1e-3; /* a shear turns the tool about y */
    for (i = 0; i < 400; ++i)
        CHECK(knead_simulation_step_tools(simulation, &pose, 5e-3, &newer.result) == KNEAD_OK);
    CHECK(newer.later == 42);
    CHECK(newer.result.force_n[0] < -0.1 && fabs(newer.result.force_n[1]) < 0.1);
    CHECK(fabs(newer.result.torque_nm[1]) > 1e-4);
    CHECK(knead_simulation_local_model(simulation, 1, &model) == KNEAD_ERROR_INVALID_ARGUMENT);
    CHECK(knead_simulation_local_model(simulation, 0, &model) == KNEAD_OK);
    /* At rest the force is what the displacement times the stiffness gives, nearly. */
    CHECK(fabs(model.stiffness[0] * 1e-3 + newer.result.force_n[0]) < 0.02 * fabs(newer.result.force_n[0]));
    CHECK(model.stiffness[1] == model.stiffness[6] && model.stiffness[4] == model.stiffness[24]);
    CHECK(model.mass[0] > 0 && model.step == 400 && model.unilateral == 0);
    model.struct_size = 8;
    CHECK(knead_simulation_local_model(simulation, 0, &model) == KNEAD_ERROR_INVALID_ARGUMENT);
    CHECK(knead_simulation_step_tools(simulation, NULL, 1e-3, &newer.result) == KNEAD_ERROR_INVALID_ARGUMENT);
    newer.result.struct_size = 8;
    CHECK(knead_simulation_step_tools(simulation, &pose, 1e-3, &newer.result) ==
          KNEAD_ERROR_INVALID_ARGUMENT);
    knead_simulation_free(simulation);
}

static void check_null_handles(void) {
    double numbers[4] = {0, 0, 0, 0};
    knead_pose pose = {{0, 0, 0}, {1, 0, 0, 0}};
    knead_local_model model;
    knead_step_result result;
    knead_local_model_init(&model);
    knead_step_result_init(&result);
    CHECK(knead_simulation_step(NULL, numbers, NULL, 1e-3, &result) == KNEAD_ERROR_INVALID_ARGUMENT);
    CHECK(knead_simulation_reset(NULL) == KNEAD_ERROR_INVALID_ARGUMENT);
    CHECK(knead_simulation_rest_pose(NULL, 0, &pose) == KNEAD_ERROR_INVALID_ARGUMENT);
    CHECK(knead_simulation_step_tools(NULL, &pose, 1e-3, &result) == KNEAD_ERROR_INVALID_ARGUMENT);
    CHECK(knead_simulation_local_model(NULL, 0, &model) == KNEAD_ERROR_INVALID_ARGUMENT);
    CHECK(knead_simulation_velocities_m_per_s(NULL, numbers) == KNEAD_ERROR_INVALID_ARGUMENT);
    CHECK(knead_simulation_tool_count(NULL) == 0);
    CHECK(knead_simulation_node_count(NULL) == 0);
    CHECK(knead_simulation_positions_m(NULL) == NULL);
    knead_simulation_free(NULL);
}

int main(int argc, char** argv) {
    if (argc != 2) return 2;
    check_names();
    check_failed_loads(argv[1]);
    check_press(argv[1]);
    check_what_is_asked_for(argv[1]);
    check_null_handles();
    return failures == 0 ? 0 : 1;
}
