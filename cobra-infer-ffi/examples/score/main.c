/* Scores the pose of a linked-in file against a linked-in template, and shows what is refused.
 *
 * Some of the file's correspondences are unsound, so that the answer on all of them is undecided; on
 * the sound ones alone there is a decision.
 *
 * The same on firmware and on a host. Prints the bits of every result, so that runs on different
 * processors can be compared. */

#include "cobra_infer.h"

#include <inttypes.h>
#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <string.h>

/* inputs.S; the template's bytes may lie at any address. */
extern const unsigned char template_start[], template_end[];
extern const unsigned char crowded_start[], crowded_end[];
extern const unsigned char points_start[], points_end[];

/* What a template damaged in RAM is copied to. */
static unsigned char damaged[256 * 1024];

/* All that the library needs of RAM besides its stack. 8 is both alignments of the header. */
static union {
    unsigned char bytes[COBRA_TEMPLATE_SIZE];
    uint64_t alignment;
} template_memory;
static union {
    unsigned char bytes[COBRA_SCORER_SIZE];
    uint64_t alignment;
} scorer_memory;

static const char *const reasons[] = {
    "not-scored",    "accept",         "below-threshold", "no-support",
    "behind-camera", "too-few-points", "no-weight",       "non-finite-input",
    "negative-weight", "no-threshold",
};

static uint32_t bits(float value)
{
    uint32_t result;
    memcpy(&result, &value, sizeof result);
    return result;
}

/* Reads from a file of little-endian numbers, on a little-endian processor. */
static const unsigned char *take(const unsigned char *from, void *to, size_t length)
{
    memcpy(to, from, length);
    return from + length;
}

static CobraStatus load(const unsigned char *start, const unsigned char *end,
                        CobraTemplate **loaded)
{
    return cobra_template_load(&template_memory, sizeof template_memory, start,
                               (size_t)(end - start), loaded);
}

static bool is_sound(const float numbers[6])
{
    int i;
    for (i = 0; i < 6; i++) {
        if (!isfinite(numbers[i])) {
            return false;
        }
    }
    return numbers[5] >= 0; /* the weight */
}

static CobraStatus score(CobraTemplate *loaded, bool only_sound)
{
    const unsigned char *next = points_start;
    CobraCamera camera;
    CobraPose pose;
    CobraSettings settings;
    CobraScorer *scorer;
    CobraReport report;
    CobraStatus status;
    uint32_t poses, count;

    next = take(next, camera.matrix, sizeof camera.matrix);
    next = take(next, &poses, sizeof poses);
    take(take(next, pose.rotation, sizeof pose.rotation), pose.translation,
         sizeof pose.translation);
    next += poses * (sizeof pose.rotation + sizeof pose.translation);
    next = take(next, &count, sizeof count);

    /* A tolerance of 2 mm; the camera and the estimator place a point to 0.5 units. */
    status = cobra_settings_default(loaded, 2.0f, &settings);
    if (status != COBRA_STATUS_OK) {
        return status;
    }
    settings.sigma = 0.5f;
    status = cobra_scorer_start(&scorer_memory, sizeof scorer_memory, loaded, &camera, &pose,
                                &settings, &scorer);
    if (status != COBRA_STATUS_OK) {
        return status;
    }
    while (count-- > 0) {
        float numbers[6];
        float likelihood;
        CobraCorrespondence correspondence;

        next = take(next, numbers, sizeof numbers);
        if (only_sound && !is_sound(numbers)) {
            continue;
        }
        correspondence.u = numbers[0];
        correspondence.v = numbers[1];
        correspondence.x = numbers[2];
        correspondence.y = numbers[3];
        correspondence.z = numbers[4];
        correspondence.weight = numbers[5];
        status = cobra_scorer_push(scorer, &correspondence, &likelihood);
        if (status != COBRA_STATUS_OK) {
            return status;
        }
        printf("%08" PRIx32 "\n", bits(likelihood));
    }
    status = cobra_scorer_finish(scorer, &report);
    if (status != COBRA_STATUS_OK) {
        return status;
    }
    printf("confidence %08" PRIx32 " threshold %08" PRIx32 " weight_sum %08" PRIx32
           " inlier_share %08" PRIx32 " points %" PRIu32 " behind_camera %" PRIu32 " decision %s\n",
           bits(report.confidence), bits(report.threshold), bits(report.weight_sum),
           bits(report.inlier_share), report.points, report.behind_camera,
           reasons[report.reason]);
    return next == points_end ? COBRA_STATUS_OK : COBRA_STATUS_LENGTH_TOO_LARGE;
}

int main(void)
{
    size_t length = (size_t)(template_end - template_start);
    CobraTemplate *loaded;
    CobraStatus status;

    status = load(template_start, template_end, &loaded);
    if (status == COBRA_STATUS_OK) {
        status = score(loaded, false);
    }
    if (status == COBRA_STATUS_OK) {
        status = score(loaded, true);
    }
    if (status != COBRA_STATUS_OK) {
        printf("failed: %s\n", cobra_status_string(status));
        return 1;
    }

    if (length > sizeof damaged) {
        printf("the template is larger than the example's buffer\n");
        return 1;
    }
    memcpy(damaged, template_start, length);
    damaged[length / 2] ^= 1;
    status = load(damaged, damaged + length, &loaded);
    printf("damaged: %s\n", cobra_status_string(status));
    if (status == COBRA_STATUS_OK || loaded != NULL) {
        return 1;
    }

    status = load(crowded_start, crowded_end, &loaded);
    if (status == COBRA_STATUS_OK) {
        status = score(loaded, false);
    }
    printf("crowded: %s\n", cobra_status_string(status));
    return status == COBRA_STATUS_OK;
}
