/* Parts of ritz_audit_component: what its checks share. Not for users. */
#ifndef RITZ_CHECK_AUDIT_PARTS_H
#define RITZ_CHECK_AUDIT_PARTS_H

#include <ritz/audit.h>
#include <ritz/component.h>

#include <stdarg.h>

enum {
    RITZ_AUDIT_MOST = 32, /* checks; the table in audit.h has fewer */
    RITZ_SHOWN = 4,       /* dofs that a line names before it says "..." */
};

/* Grids no further apart, over the component's size, are in one place. */
#define RITZ_SAME_PLACE 1e-9

/* Forces K r of rigid motions, and what an error of size 1 leaves of them. */
typedef struct ritz_forces {
    double largest;
    int64_t row; /* where; -1: there is none */
    double bound;
    double fine; /* relative error that is no fault */
} ritz_forces;

/**
 * Put a check behind the others, if there is room for it.
 *
 * @param[in] most   that there is room for
 * @param[in] found  name, value, limit and verdict
 * @param[in] where  NULL: nowhere
 */
[[gnu::format(printf, 5, 0)]] void
ritz_audit_add(ritz_audit *audit, int64_t most, const ritz_check *found,
               const char *where, const char *says, va_list values);

typedef struct ritz_auditor {
    const ritz_component *component;
    bool rigid;      /* K has no entries */
    bool placed;     /* every grid has a position */
    double digits;   /* of K, at most 17 */
    bool declared;   /* they are those that the source states, and not exact */
    bool rounded;    /* K times a rigid motion is what its digits leave */
    int64_t *part;   /* n, connected part of each dof, from 0 */
    int64_t largest; /* the part with most dofs */
    ritz_forces shift, turn; /* of translations; of rotations */
    double centre[3];
    double size;      /* largest distance of a grid from the centre, or 1 */
    ritz_dense R;     /* n x 3 or 6, rotations per unit of size */
    double softest;   /* first flexible eigenvalue, NaN if not known */
    ritz_dense Phi;   /* n x k, rigid motions by geometry, Phi'M Phi = I */
    double *mu;       /* k, Phi'K Phi, ascending  [rad^2/s^2] */
    int64_t num_free; /* of Phi, that meet no stiffness */
    ritz_audit audit;
} ritz_auditor;

/** Append a check; @p where may be NULL. */
[[gnu::format(printf, 7, 8)]] void
ritz_auditor_say(ritz_auditor *it, const char *name, double value, double limit,
                 ritz_verdict verdict, const char *where, const char *says,
                 ...);

/** Name the first dofs that are flagged; the number of all of them. */
int64_t ritz_auditor_where(const ritz_auditor *it, const bool *flag,
                           char where[RITZ_WHERE_SIZE]);

/** Append @p text to a list, ", ..." once where it is full. */
void ritz_auditor_list(char where[RITZ_WHERE_SIZE], const char *text);

/** What the k-th dof of a port is. */
ritz_dof ritz_auditor_dof(const ritz_auditor *it, const ritz_port *port,
                          int64_t k);

/** Set `digits` and `declared` from K, which has entries. */
ritz_status ritz_audit_digits(ritz_auditor *it);

/* The checks, in this order: each uses what those before it left. */
ritz_status ritz_audit_values(ritz_auditor *it, bool *usable);
ritz_status ritz_audit_dofs(ritz_auditor *it);
ritz_status ritz_audit_definite(ritz_auditor *it);
ritz_status ritz_audit_geometry(ritz_auditor *it);
ritz_status ritz_audit_forces(ritz_auditor *it);
ritz_status ritz_audit_rigid(ritz_auditor *it);
ritz_status ritz_audit_grounding(ritz_auditor *it);
ritz_status ritz_audit_mass(ritz_auditor *it);
ritz_status ritz_audit_damping(ritz_auditor *it);
ritz_status ritz_audit_ports(ritz_auditor *it);

/** The part of the ports that asks whether their grids lie on one line. */
ritz_status ritz_audit_port_rank(ritz_auditor *it);

#endif
