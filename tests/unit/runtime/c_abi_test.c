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
    CHECK(strcmp(knead_step_status_name(1u << 30), "unknown") == 0);
    CHECK(knead_version()[0] != '\0');
}

static void check_failed_loads(const char* asset) {
    knead_simulation* simulation = (knead_simulation*)&failures;
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
    config.tool = 7;
    CHECK(knead_simulation_load(asset, &config, &simulation) == KNEAD_ERROR_INVALID_ARGUMENT);
    CHECK(strstr(knead_last_error(NULL), "tool") != NULL);
}

static void check_press(const char* asset) {
    knead_simulation* simulation = NULL;
    knead_step_result result;
    double position[3], orientation[4];
    int i;
    if (knead_simulation_load(asset, NULL, &simulation) != KNEAD_OK) {
        fprintf(stderr, "%s\n", knead_last_error(NULL));
        ++failures;
        return;
    }
    CHECK(knead_last_error(NULL)[0] == '\0');
    CHECK(knead_simulation_node_count(simulation) == 343);
    CHECK(knead_simulation_tetrahedron_count(simulation) > 1000);
    CHECK(knead_simulation_rest_pose(simulation, position, orientation) == KNEAD_OK);
    knead_step_result_init(&result);
    for (i = 1; i <= 300; ++i) {
        position[2] = 0.1 - 0.01 * (i < 50 ? i / 50.0 : 1.0);
        CHECK(knead_simulation_step(simulation, position, i % 2 ? orientation : NULL, 20e-3, &result) ==
              KNEAD_OK);
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

static void check_null_handles(void) {
    double numbers[4] = {0, 0, 0, 0};
    knead_step_result result;
    knead_step_result_init(&result);
    CHECK(knead_simulation_step(NULL, numbers, NULL, 1e-3, &result) == KNEAD_ERROR_INVALID_ARGUMENT);
    CHECK(knead_simulation_reset(NULL) == KNEAD_ERROR_INVALID_ARGUMENT);
    CHECK(knead_simulation_rest_pose(NULL, numbers, numbers) == KNEAD_ERROR_INVALID_ARGUMENT);
    CHECK(knead_simulation_node_count(NULL) == 0);
    CHECK(knead_simulation_positions_m(NULL) == NULL);
    knead_simulation_free(NULL);
}

int main(int argc, char** argv) {
    if (argc != 2) return 2;
    check_names();
    check_failed_loads(argv[1]);
    check_press(argv[1]);
    check_null_handles();
    return failures == 0 ? 0 : 1;
}
