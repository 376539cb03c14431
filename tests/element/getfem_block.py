#!/usr/bin/python3
"""A block with fibres by GetFEM (python3-getfem): `getfem_block.py bending|torsion M` for `references`, which see.

The mesh has 4M x M x M cubes with quadratic shape functions (Q2, 27 nodes). GetFEM derives the tangent of the stresses,
which are written here as text: of mu/2 (J^-2/3 tr C - 3) + K/2 (J - 1)^2, and of fibres along a0 by full C,
k1/(2 k2) (exp(k2 Ebar^2) - 1) where Ebar = kappa (tr C - 3) + (1 - 3 kappa) (a0.C a0 - 1) is above 0.
"""
import math
import sys

import getfem as gf
import numpy as np

VALUES = {"mu": 1e4, "K": 1e5, "k1": 2e4, "k2": 2, "kappa": 0.1, "a": [math.cos(math.pi / 6), 0, math.sin(math.pi / 6)]}
F = "(Id(3)+Grad_u)"
J = f"Det({F})"
E = f"({F}'*{F}-Id(3))"
TRACE = f"(3+Trace({E}))"
STRAIN = f"pos_part(kappa*Trace({E})+(1-3*kappa)*(({E}*a).a))"
ROUND = f"mu*pow({J},-2/3)*({F}-{TRACE}/3*Inv({F})')+K*({J}-1)*{J}*Inv({F})'"
FIBRES = f"2*k1*{STRAIN}*exp(k2*sqr({STRAIN}))*{F}*(kappa*Id(3)+(1-3*kappa)*(a@a))"
ENERGY = f"mu/2*(pow({J},-2/3)*{TRACE}-3)+K/2*sqr({J}-1)+k1/(2*k2)*(exp(k2*sqr({STRAIN}))-1)"


def block(thick):
    sides = [np.linspace(0, side, count + 1) for side, count in ((4e-2, 4 * thick), (1e-2, thick), (1e-2, thick))]
    mesh = gf.Mesh("cartesian", *sides)
    u = gf.MeshFem(mesh, 3)
    u.set_fem(gf.Fem("FEM_QK(3,2)"))
    for region, normal in ((1, [-1, 0, 0]), (2, [1, 0, 0])):
        mesh.set_region(region, mesh.outer_faces_with_direction(normal, 0.1))
    return u, gf.MeshIm(mesh, gf.Integ("IM_GAUSS_PARALLELEPIPED(3,4)"))


def model(u, integration):
    md = gf.Model("real")
    md.add_fem_variable("u", u)
    for name, value in VALUES.items():
        md.add_initialized_data(name, value)
    for stress in (ROUND, FIBRES):
        md.add_nonlinear_term(integration, f"({stress}):Grad_Test_u")
    md.add_Dirichlet_condition_with_simplification("u", 1)
    return md


def solve(md):
    md.solve("max_iter", 60, "max_res", 1e-9, "lsolver", "mumps", "lsearch", "simplest", "alpha min", 0.2)


def bending(md, u, integration):
    """The mean of the end's displacement along z, mm."""
    md.add_initialized_data("weight", [0, 0, 0])
    md.add_source_term_brick(integration, "u", "weight")
    for part in (0.25, 0.5, 0.75, 1):
        md.set_variable("weight", [0, 0, 8000 * part])
        solve(md)
    return 1e3 * gf.asm_generic(integration, 0, "u(3)", 2, md) / 1e-4


def torsion(md, u, integration):
    """What is stored, mJ."""
    y, z = (u.basic_dof_nodes()[axis, 0::3] - 5e-3 for axis in (1, 2))
    md.add_initialized_fem_data("turn", u, np.zeros(u.nbdof()))
    md.add_Dirichlet_condition_with_simplification("u", 2, "turn")
    for angle in np.radians(np.linspace(0, 60, 7)[1:]):
        s, c = math.sin(angle), math.cos(angle) - 1
        md.set_variable("turn", np.array([0 * y, c * y - s * z, s * y + c * z]).T.flatten())
        solve(md)
    return 1e3 * gf.asm_generic(integration, 0, ENERGY, -1, md)


def main():
    gf.util_trace_level(0)
    u, integration = block(int(sys.argv[2]))
    print(f"{ {'bending': bending, 'torsion': torsion}[sys.argv[1]](model(u, integration), u, integration):.7g}")


main()
