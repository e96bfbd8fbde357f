"""A straight beam along x whose grids have six directions."""
import numpy

E, G, RHO, AREA, I_Y, I_Z, J = 7e9, 2.7e9, 2700.0, 1e-3, 2e-6, 5e-6, 4e-6


def bending(h, EI, sign):
    """Stiffness and consistent mass, of deflections and rotations."""
    K = EI / h**3 * numpy.array([[12, 6*h, -12, 6*h],
                                 [6*h, 4*h*h, -6*h, 2*h*h],
                                 [-12, -6*h, 12, -6*h],
                                 [6*h, 2*h*h, -6*h, 4*h*h]])
    M = RHO * AREA * h / 420 * numpy.array([[156, 22*h, 54, -13*h],
                                            [22*h, 4*h*h, 13*h, -3*h*h],
                                            [54, 13*h, 156, -22*h],
                                            [-13*h, -3*h*h, -22*h, 4*h*h]])
    turn = numpy.diag([1, sign, 1, sign])
    return turn @ K @ turn, turn @ M @ turn


def beam(length, cells, body_mass, body_inertia):
    """K and M of a free beam with a lumped body at its first grid."""
    n, h = 6 * (cells + 1), length / cells
    K, M = numpy.zeros((n, n)), numpy.zeros((n, n))
    for first in range(0, 6 * cells, 6):
        for dofs, EI, sign in (([1, 5, 7, 11], E * I_Z, 1),
                               ([2, 4, 8, 10], E * I_Y, -1)):
            at = numpy.ix_(first + numpy.array(dofs), first + numpy.array(dofs))
            K_e, M_e = bending(h, EI, sign)
            K[at] += K_e
            M[at] += M_e
        for dofs, stiff, mass in (([0, 6], E * AREA, RHO * AREA),
                                  ([3, 9], G * J, RHO * (I_Y + I_Z))):
            at = numpy.ix_(first + numpy.array(dofs), first + numpy.array(dofs))
            K[at] += stiff / h * numpy.array([[1, -1], [-1, 1]])
            M[at] += mass * h / 6 * numpy.array([[2, 1], [1, 2]])
    M[range(6), range(6)] += (body_mass,) * 3 + tuple(body_inertia)
    return K, M
