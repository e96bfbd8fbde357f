"""Programs as they are written in an afternoon: right in theory, and without the
care that this folder shows the need of."""
import numpy as np
import scipy.linalg as la


def lanczos(K, M, sigma, steps, seed=1):
    """Eigenvalues by Lanczos on (K - sigma M)^-1 M, from one vector, with full
    reorthogonalisation."""
    start = np.random.default_rng(seed).standard_normal(len(K))
    lu = la.lu_factor(K - sigma * M)
    V = np.zeros((len(K), steps))
    alpha, beta = np.zeros(steps), np.zeros(steps)
    v = start / np.sqrt(start @ M @ start)
    for j in range(steps):
        V[:, j] = v
        w = la.lu_solve(lu, M @ v)
        alpha[j] = v @ M @ w
        for _ in range(2):
            w -= V[:, :j + 1] @ (V[:, :j + 1].T @ (M @ w))
        beta[j] = np.sqrt(w @ M @ w)
        v = w / beta[j]
    return np.sort(sigma + 1 / la.eigvalsh_tridiagonal(alpha, beta[:-1]))


def hertz(eigenvalues):
    """Frequencies, as everybody prints them: sqrt of what is above zero."""
    return np.sqrt(np.maximum(eigenvalues, 0)) / (2 * np.pi)


def companion(K, M, D):
    """A of x = [u; u']."""
    n = len(K)
    return np.block([[np.zeros((n, n)), np.eye(n)],
                     [-la.solve(M, K), -la.solve(M, D)]])


def response(K, M, D, b, c, omega):
    """c' (K + i w D - w^2 M)^-1 b."""
    return np.array([c @ la.solve(K + 1j * w * D - w * w * M, b)
                     for w in omega])


def gramians(A, B, C):
    """W_c and W_o."""
    return (la.solve_continuous_lyapunov(A, -B @ B.T),
            la.solve_continuous_lyapunov(A.T, -C.T @ C))


def residual_basis(K, M, modes, rows):
    """Lowest modes, and what K^-1 answers to unit forces beyond them."""
    eigenvalues, Phi = la.eigh(K, M)
    kept = Phi[:, :modes]
    F = np.eye(len(K))[:, rows]
    return np.hstack([kept, la.solve(K, F) - kept @ (
        kept.T @ F / eigenvalues[:modes, None])])


def modal_damping(K, M, zeta):
    """D of one ratio for all modes; their frequencies and shapes."""
    eigenvalues, Phi = la.eigh(K, M)
    omega = np.sqrt(np.maximum(eigenvalues, 0))
    MPhi = M @ Phi
    return MPhi * (2 * zeta * omega) @ MPhi.T, omega, Phi


def first_order(model, b, c):
    """A, B, C of one force b and one displacement c."""
    n = len(model.K)
    return (companion(model.K, model.M, model.D),
            np.r_[np.zeros(n), la.solve(model.M, b)][:, None],
            np.r_[c, np.zeros(n)][None, :])


def unit(n, i):
    return np.eye(n)[i]


def growth(A):
    """The pole farthest right, upper one."""
    poles = la.eigvals(A)
    pole = poles[np.argmax(poles.real)]
    return complex(pole.real, abs(pole.imag))
