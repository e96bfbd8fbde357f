/*
 * A reduced component in coordinates that begin with the motions of its
 * interface,
 *
 *     q = V [x; eta],
 *
 * x the six motions, along basic axes, of each grid of some ports, and eta the
 * modes of the body whose interface is held. With T_b the rows of these
 * motions, T_b q = x, and N a basis of the null space of T_b, modes with the
 * interface held and static responses to unit motions are
 *
 *     N'K N Y = N'M N Y diag(lambda),     N Y,
 *     V_x = (I - N Y diag(1/lambda) Y'N'K) T_b^+,
 *
 * so that V'K V = [K_x, 0; 0, diag(lambda)] and V'M V = [M_x, M_xm; ., I]: the
 * form of Craig and Bampton, in the subspace of any method [CraigBampton1968].
 * Modes without stiffness are added to V_x, so that a rigid motion of the frames
 * moves all of the body as a rigid one.
 */
#ifndef RITZ_MODEL_INTERFACE_FORM_H
#define RITZ_MODEL_INTERFACE_FORM_H

#include <ritz/model.h>

enum { RITZ_FRAME_MOTIONS = 6 };

typedef struct ritz_interface_form {
    int64_t count;                /* k, grids of the interface */
    int64_t *grid;                /* k, in the order of the ports */
    double *position;             /* k x 3 */
    char (*port)[RITZ_NAME_SIZE]; /* k, of each grid */
    bool kept;     /* x are coordinates of the basis already, perhaps turned,
                        without stiffness that couples them to the others: V
                        only orders and turns them, and eta are as they were */
    double *hertz; /* r - 6k, of the modes; NULL: kept */
    int64_t num_loose; /* modes without stiffness, as of a hinge; they are the
                          first */
    ritz_dense V;      /* r x r */
    ritz_dense K, M;   /* r x r */
    ritz_dense D;      /* r x r, that of stated damping included; {0}: none */
} ritz_interface_form;

/**
 * @param[in] ports  names with commas between them; NULL: the ports that were
 *                   attached, whose grids constraint modes move, or all ports
 *                   where there are no constraint modes
 * @return RITZ_ERR_ARGUMENT if there is no such port, a grid has not all six
 *         motions, motions depend on each other, or coordinates have no mass
 * @cost   O(r^3)
 */
ritz_status ritz_interface_form_of(const ritz_reduced *reduced,
                                   const char *ports, ritz_interface_form *out);

/* How the ground holds a body. */
typedef struct ritz_interface_ground {
    double rigid_hz;    /* largest sqrt(r'K r / r'M r) of the six rigid motions
                           r of the interface; rounding where it is free */
    double flexible_hz; /* of the first flexible mode, its size where K is
                           indefinite; 0: there is none */
    bool holds;         /* rigid_hz is more than RITZ_HELD of flexible_hz */
} ritz_interface_ground;

/** Whether the ground holds the body, and how stiffly. @cost O(r^3) */
ritz_status ritz_interface_form_ground(const ritz_interface_form *form,
                                       ritz_interface_ground *out);

/** Modes of the body with its interface held: eigenpairs of the blocks of K and
 * M after the motions x. @cost O(r^3) */
ritz_status ritz_interface_form_modes(const ritz_interface_form *form,
                                      ritz_pairs *out);

void ritz_interface_form_free(ritz_interface_form *form);

#endif
