#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later

# CHOLMOD notices that a matrix is not positive definite only when the matrix is large enough; and even then it returns "success".
#
# Expected: a Cholesky factorization fails on a matrix that is not positive definite, so the loss of stability of a loaded structure
#   (buckling, a wrong sign in a follower load, a contact penalty gone wrong) is found where cholmod_factorize complains. By the
#   names, cholmod_factorize returns false then.
# Seen (libcholmod3 1:5.12.0+dfsg-2 of Debian 12, defaults), the 7-point operator on n^3 nodes, shifted so that exactly one
#   eigenvalue is negative:
#     n    unknowns   returned   L->minor     status        factor
#      6        216          1   = n          OK            simplicial LDL', one negative number in D
#     12       1728          1   < n          NOT_POSDEF    supernodal LL', stopped half-way
#   By default small matrices get an LDL', which exists for most indefinite matrices; large ones (by a count of operations per entry)
#   an LL', which does not. Size is a property of the mesh: the model is stable on the coarse one and unstable on the fine one. The
#   return value is true each time; only the status, a positive number that means a warning, and L->minor tell.
# Matters: a Newton step from such a factor goes towards a saddle, and the coarse mesh on which one tries a scene is what hides it.
# Do: ask for LL' always (Common.final_ll = 1 or Common.supernodal = CHOLMOD_SUPERNODAL, each suffices) or look at the signs of D; and
#   test minor == n, not what is returned.
#
# Needs Debian 12 (apt-get, dpkg, python3). Exit 0: as described; 1: changed; 2: could not be tried.
set -euo pipefail
tmp=$(mktemp -d)
trap 'rm -rf "$tmp"' EXIT
cd "$tmp"

deb() {  # deb PACKAGE=VERSION...: they and what they need (but the C library) unpacked in $tmp/root, nothing installed
  mkdir -p apt/archives/partial root && : >none
  apt-get -qq -y -o Dir::State::status="$tmp/none" -o Dir::Cache="$tmp/apt" -o Debug::NoLocking=1 -o APT::Sandbox::User=root \
    --no-install-recommends --download-only install "$@" >apt.log 2>&1 || { cat apt.log; echo "packages could not be had"; exit 2; }
  rm -f apt/archives/libc6_* apt/archives/libc-bin_*
  for archive in apt/archives/*.deb; do dpkg -x "$archive" root; done
}
deb libcholmod3=1:5.12.0+dfsg-2
lib=$(echo "$tmp"/root/usr/lib/*-linux-gnu)

cat >factor.py <<'PY'
import ctypes as c
import math

chol, libc = c.CDLL('libcholmod.so.3'), c.CDLL(None)
libc.fopen.restype = c.c_void_p
chol.cholmod_read_sparse.restype = chol.cholmod_analyze.restype = c.c_void_p
chol.cholmod_read_sparse.argtypes = [c.c_void_p, c.c_void_p]
chol.cholmod_analyze.argtypes = [c.c_void_p, c.c_void_p]
chol.cholmod_factorize.argtypes = [c.c_void_p] * 3

class Factor(c.Structure):
    """The head of cholmod_factor, as cholmod_core.h 3.0.14 declares it."""
    _fields_ = [('n', c.c_size_t), ('minor', c.c_size_t), ('perm', c.c_void_p), ('colcount', c.c_void_p), ('iperm', c.c_void_p),
                ('nzmax', c.c_size_t), ('p', c.POINTER(c.c_int)), ('i', c.c_void_p), ('x', c.POINTER(c.c_double)), ('z', c.c_void_p),
                ('nz', c.c_void_p), ('next', c.c_void_p), ('prev', c.c_void_p), ('nsuper', c.c_size_t), ('ssize', c.c_size_t),
                ('xsize', c.c_size_t), ('maxcsize', c.c_size_t), ('maxesize', c.c_size_t), ('super', c.c_void_p),
                ('pi', c.c_void_p), ('px', c.c_void_p), ('s', c.c_void_p), ('ordering', c.c_int), ('is_ll', c.c_int),
                ('is_super', c.c_int)]

def write(n, name):
    """The lower triangle of the operator, shifted to the middle between its first and its second eigenvalue."""
    first, second = (2 - 2 * math.cos(k * math.pi / (n + 1)) for k in (1, 2))
    diagonal = 6 - (3 * first + 2 * first + second) / 2
    lines = []
    for k in range(n ** 3):
        lines.append(f'{k + 1} {k + 1} {diagonal!r}')
        for step, at in ((1, k % n), (n, k // n % n), (n * n, k // n // n)):
            if at < n - 1:
                lines.append(f'{k + step + 1} {k + 1} -1')
    with open(name, 'w') as out:
        out.write(f'%%MatrixMarket matrix coordinate real symmetric\n{n ** 3} {n ** 3} {len(lines)}\n' + '\n'.join(lines) + '\n')

for n in (6, 12):
    write(n, 'matrix.mtx')
    common = c.create_string_buffer(1 << 16)  # more than a cholmod_common takes
    chol.cholmod_start(common)
    matrix = chol.cholmod_read_sparse(libc.fopen(b'matrix.mtx', b'r'), common)
    factor = chol.cholmod_analyze(matrix, common)
    returned = chol.cholmod_factorize(matrix, factor, common)
    f = Factor.from_address(factor)
    negative = 'unknown' if f.is_ll else sum(f.x[f.p[j]] < 0 for j in range(f.n))
    print(f'unknowns {f.n} returned {returned} complete {f.minor == f.n} LL {f.is_ll} supernodal {f.is_super} negative in D {negative}')
PY
OPENBLAS_NUM_THREADS=1 LD_LIBRARY_PATH=$lib:$lib/blas:$lib/lapack python3 factor.py >said 2>&1 || { cat said; exit 2; }
grep '^unknowns' said | tee seen || { cat said; exit 2; }
diff seen - <<'SEEN' || { echo "changed"; exit 1; }
unknowns 216 returned 1 complete True LL 0 supernodal 0 negative in D 1
unknowns 1728 returned 1 complete False LL 1 supernodal 1 negative in D unknown
SEEN
echo "as described"
