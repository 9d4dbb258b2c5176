/* SPDX-License-Identifier: Apache-2.0 */
/* c_haptics_test ASSET: the C interface of the haptic loop, compiled as C. Says what failed; exit status 0 if
 * nothing did. The asset is the cube of write_cube. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "knead/knead_haptics.h"

static int failures = 0;

#define CHECK(condition)                                                      \
    do {                                                                      \
        if (!(condition)) {                                                   \
            fprintf(stderr, "line %d: not true: %s\n", __LINE__, #condition); \
            ++failures;                                                       \
        }                                                                     \
    } while (0)

/* A device whose hand is moved by the test, and which remembers what it was given. */
typedef struct hand {
    double position_m[3];
    double time_s;
    int stopped; /* its clock stands still */
    double force_n[3];
    double longest_n;
    long reads, writes;
} hand;

static void read_hand(void* user, knead_device_state* state) {
    hand* self = (hand*)user;
    if (!self->stopped) self->time_s += 1e-3;
    ++self->reads;
    CHECK(state->orientation_wxyz[0] == 1 && state->orientation_wxyz[3] == 0);
    memcpy(state->position_m, self->position_m, sizeof state->position_m);
    state->time_s = self->time_s;
    state->buttons = 2;
}

static void write_hand(void* user, const double force_n[3], const double torque_nm[3]) {
    hand* self = (hand*)user;
    const double norm = sqrt(force_n[0] * force_n[0] + force_n[1] * force_n[1] + force_n[2] * force_n[2]);
    (void)torque_nm;
    ++self->writes;
    memcpy(self->force_n, force_n, sizeof self->force_n);
    if (!(norm <= self->longest_n)) self->longest_n = norm;
}

static const hand at_rest = {{0.05, 0.05, 0.1}, 0, 0, {0, 0, 0}, 0, 0, 0};

static void check_failed_loads(const char* asset) {
    hand self = at_rest;
    knead_device device = {NULL, read_hand, write_hand};
    knead_haptic_config config;
    knead_haptic_loop* loop = (knead_haptic_loop*)&self;
    device.user = &self;
    CHECK(knead_haptic_loop_load("/nowhere/at/all.hdf", NULL, &device, &loop) == KNEAD_ERROR_IO);
    CHECK(loop == NULL && strstr(knead_haptic_last_error(NULL), "all.hdf") != NULL);
    CHECK(knead_haptic_loop_load(NULL, NULL, &device, &loop) == KNEAD_ERROR_INVALID_ARGUMENT);
    CHECK(knead_haptic_loop_load(asset, NULL, NULL, &loop) == KNEAD_ERROR_INVALID_ARGUMENT);
    CHECK(knead_haptic_loop_load(asset, NULL, &device, NULL) == KNEAD_ERROR_INVALID_ARGUMENT);
    memset(&config, 0, sizeof config);
    CHECK(knead_haptic_loop_load(asset, &config, &device, &loop) == KNEAD_ERROR_INVALID_ARGUMENT);
    CHECK(strstr(knead_haptic_last_error(NULL), "struct_size") != NULL);
    knead_haptic_config_init(&config);
    config.mode = 9;
    CHECK(knead_haptic_loop_load(asset, &config, &device, &loop) == KNEAD_ERROR_INVALID_ARGUMENT);
    CHECK(strstr(knead_haptic_last_error(NULL), "mode") != NULL);
    knead_haptic_config_init(&config);
    config.max_force_n = -1;
    CHECK(knead_haptic_loop_load(asset, &config, &device, &loop) == KNEAD_ERROR_INVALID_ARGUMENT);
    CHECK(strstr(knead_haptic_last_error(NULL), "max_force_n") != NULL);
    device.write = NULL;
    CHECK(knead_haptic_loop_load(asset, NULL, &device, &loop) == KNEAD_ERROR_INVALID_ARGUMENT);
    CHECK(self.reads == 0 && self.writes == 0);
}

/* A press beyond what the device can give, then a device that stands still. */
static void check_ticks(const char* asset) {
    hand self = at_rest;
    knead_device device = {NULL, read_hand, write_hand};
    knead_haptic_loop* loop = NULL;
    knead_haptic_tick tick;
    knead_pose pose;
    int i;
    device.user = &self;
    if (knead_haptic_loop_load(asset, NULL, &device, &loop) != KNEAD_OK) {
        fprintf(stderr, "%s\n", knead_haptic_last_error(NULL));
        ++failures;
        return;
    }
    CHECK(knead_haptic_loop_rest_pose(loop, &pose) == KNEAD_OK && fabs(pose.position_m[2] - 0.1) < 1e-12);
    memset(&tick, 0, sizeof tick);
    CHECK(knead_haptic_loop_tick(loop, 1e-3, &tick) == KNEAD_ERROR_INVALID_ARGUMENT);
    CHECK(strstr(knead_haptic_last_error(loop), "struct_size") != NULL);
    knead_haptic_tick_init(&tick);
    for (i = 1; i <= 1500; ++i) {
        self.position_m[2] = 0.1 - 0.02 * (i < 500 ? i / 500.0 : 1.0);
        CHECK(knead_haptic_loop_tick(loop, 1e-3, i % 2 ? &tick : NULL) == KNEAD_OK);
    }
    CHECK(knead_haptic_loop_tick(loop, 1e-3, &tick) == KNEAD_OK);
    CHECK(tick.number == 1501 && tick.device.buttons == 2 && tick.step_status == 0);
    CHECK((tick.haptic_status & KNEAD_HAPTIC_SATURATED) != 0);
    CHECK(fabs(self.force_n[2] - 3.3) < 1e-3 && fabs(self.longest_n - 3.3) < 1e-9);
    CHECK(memcmp(self.force_n, tick.device_force_n, sizeof self.force_n) == 0);
    self.stopped = 1;
    for (i = 0; i < 51; ++i)
        CHECK(knead_haptic_loop_tick(loop, 1e-3, &tick) == KNEAD_OK);
    CHECK((tick.haptic_status & KNEAD_HAPTIC_STALE_DEVICE) != 0);
    CHECK(self.force_n[0] == 0 && self.force_n[1] == 0 && self.force_n[2] == 0);
    knead_haptic_loop_free(loop);
}

/* On threads of its own, both modes: it runs, ends, and leaves zero behind. */
static void check_threads(const char* asset, int mode) {
    hand self = at_rest;
    knead_device device = {NULL, read_hand, write_hand};
    knead_haptic_config config;
    knead_run_statistics statistics;
    knead_haptic_loop* loop = NULL;
    device.user = &self;
    knead_haptic_config_init(&config);
    config.mode = mode;
    CHECK(knead_haptic_loop_load(asset, &config, &device, &loop) == KNEAD_OK);
    if (loop == NULL) return;
    knead_run_statistics_init(&statistics);
    CHECK(knead_haptic_loop_start(loop) == KNEAD_OK);
    CHECK(knead_haptic_loop_start(loop) != KNEAD_OK);
    CHECK(knead_haptic_last_error(loop)[0] != '\0');
    CHECK(knead_haptic_loop_tick(loop, 1e-3, NULL) == KNEAD_ERROR_INVALID_ARGUMENT);
    do {
        CHECK(knead_haptic_loop_statistics(loop, &statistics) == KNEAD_OK);
    } while (statistics.ticks < 20);
    CHECK(knead_haptic_loop_stop(loop) == KNEAD_OK);
    CHECK(self.reads >= 20 && self.writes > self.reads - 1);
    CHECK(self.force_n[0] == 0 && self.force_n[1] == 0 && self.force_n[2] == 0);
    CHECK(knead_haptic_loop_stop(loop) == KNEAD_OK);
    if (mode == KNEAD_HAPTIC_TWO_RATE)
        CHECK(knead_haptic_loop_tick(loop, 1e-3, NULL) == KNEAD_ERROR_INVALID_ARGUMENT);
    statistics.struct_size = 8;
    CHECK(knead_haptic_loop_statistics(loop, &statistics) == KNEAD_ERROR_INVALID_ARGUMENT);
    knead_haptic_loop_free(loop);
}

static void check_null_handles(void) {
    CHECK(knead_haptic_loop_start(NULL) == KNEAD_ERROR_INVALID_ARGUMENT);
    CHECK(knead_haptic_loop_stop(NULL) == KNEAD_ERROR_INVALID_ARGUMENT);
    CHECK(knead_haptic_loop_tick(NULL, 1e-3, NULL) == KNEAD_ERROR_INVALID_ARGUMENT);
    CHECK(knead_haptic_loop_rest_pose(NULL, NULL) == KNEAD_ERROR_INVALID_ARGUMENT);
    CHECK(knead_haptic_loop_statistics(NULL, NULL) == KNEAD_ERROR_INVALID_ARGUMENT);
    knead_haptic_loop_free(NULL);
}

int main(int argc, char** argv) {
    if (argc != 2) return 2;
    check_failed_loads(argv[1]);
    check_ticks(argv[1]);
    check_threads(argv[1], KNEAD_HAPTIC_SYNCHRONOUS);
    check_threads(argv[1], KNEAD_HAPTIC_TWO_RATE);
    check_null_handles();
    return failures == 0 ? 0 : 1;
}
