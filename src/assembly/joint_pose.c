/* Where the settings of a joint put its second body: joints.c has the table. */
#include "assembly/joints.h"
#include "assembly/turns.h"

#include <string.h>

void ritz_joint_pose_at(const ritz_joint *joint, const double *setting,
                        ritz_joint_pose *out)
{
    double s[2] = {0.0, 0.0};
    double first[9], second[9];
    ritz_joint_pose pose = {.R = {1, 0, 0, 0, 1, 0, 0, 0, 1}};

    for (int64_t k = 0; k < joint->num_sweeps && k < 2; k++)
        s[k] = setting[joint->sweep + k];
    switch (joint->type) {
    case RITZ_JOINT_HINGE:
        ritz_turn_about(joint->axis[0], s[0], pose.R);
        break;
    case RITZ_JOINT_SLIDER:
        for (int i = 0; i < 3; i++)
            pose.d[i] = s[0] * joint->axis[0][i];
        break;
    case RITZ_JOINT_UNIVERSAL:
        ritz_turn_about(joint->axis[0], s[0], first);
        ritz_turn_about(joint->axis[1], s[1], second);
        ritz_turn_product(first, second, pose.R);
        break;
    case RITZ_JOINT_RIGID:
        memcpy(pose.d, joint->offset, sizeof pose.d);
        break;
    case RITZ_JOINT_FIXED:
    case RITZ_JOINT_SPHERICAL:
    case RITZ_JOINT_BUSHING:
        break;
    }
    *out = pose;
}
