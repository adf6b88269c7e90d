# SPDX-License-Identifier: GPL-2.0-or-later
"""The production module in scenes as users write them: what is erased, started again, mixed, periodic or shared."""

import pytest
from test_yade_contacts import yade

ERASE = """
steel = material("steel")
O.bodies.append(wall(0, axis=2, material=steel))
for k in range(4):
    O.bodies.append(sphere((0.1 * k, 0, 0.01), 0.01, material=steel))
    O.bodies[-1].state.vel = (0, 0, -12)
O.engines, O.dt = engines(), 1e-7
O.run(20, True)
O.bodies.erase(2)  # in the middle of its contact
held = []
late = O.bodies.append(sphere((0.1, 0, 0.01), 0.01, material=steel))  # another one in its place
O.bodies[late].state.vel = (0, 0, -12)
for _ in range(20):
    O.step()
    held.append(len(contacts._contacts) - O.interactions.countReal())
R, worst = 0.01, 0.0
law = pair("steel", "steel")
for k in (1, late):
    contact = O.interactions[0, k]
    u = contact.geom.penetrationDepth
    worst = max(worst, abs(contact.phys.normalForce.norm() / law.step(R, u, u)[0] - 1))  # at the largest
answer(held=held, worst=worst)
"""


@pytest.mark.yade
@pytest.mark.parametrize("law", ["thornton", "cavity"])
def test_a_body_erased_in_contact_leaves_nothing_behind(law, tmp_path):
    """YADE does not mark the end of a contact erased with its body: it must not hide a new one."""
    found = yade(tmp_path, law, ERASE)
    assert set(found["held"]) == {0} and found["worst"] <= 1e-12


AGAIN = """
path, law = [], pair("brass", "brass")

def scene():
    brass = material("brass")
    O.bodies.append([wall(0, axis=2, material=brass), sphere((0, 0, 0.01 + 1e-8), 0.01, material=brass)])
    O.bodies[1].state.vel = (0, 0, -2)
    O.engines, O.dt = engines(), 2e-7
    while O.bodies[1].state.vel[2] < 0 or O.interactions.countReal():
        O.step()
    path.append(O.bodies[1].state.vel[2].hex())
    O.bodies[1].state.vel = (0, 0, -2)  # the same bodies meet again: YADE forgot the dent when they parted
    O.bodies[1].state.pos = (0, 0, 0.01 + 1e-8)
    while O.bodies[1].state.vel[2] < 0 or O.interactions.countReal():
        O.step()
    path.append(O.bodies[1].state.vel[2].hex())

scene()
O.reset()
contacts = Contacts(name)
scene()
O.switchScene()
contacts = Contacts(name)
scene()
answer(path=path)
"""


@pytest.mark.yade
@pytest.mark.parametrize("law", ["johnson", "cavity"])
def test_a_second_impact_a_reset_and_another_scene_start_afresh(law, tmp_path):
    assert len(set(yade(tmp_path, law, AGAIN)["path"])) == 1


PERIODIC = """
steel, R, L = material("steel"), 0.01, 0.1
e = []
for shift in (0.0, 0.5 * L):  # the contact inside the cell, and across its face
    O.reset()
    contacts = Contacts(name)
    steel = material("steel")
    O.periodic, O.cell.hSize = True, Matrix3(L, 0, 0, 0, L, 0, 0, 0, L)
    O.bodies.append([sphere((0, 0, 0.5 * L + shift + s * (R + 1e-8)), R, material=steel) for s in (-1, 1)])
    for k, s in ((0, 1), (1, -1)):
        O.bodies[k].state.vel = (0, 0, 5 * s)
    bounds = [Bo1_Sphere_Aabb()]
    O.engines = [ForceResetter(), InsertionSortCollider(bounds, verletDist=1e-3), *contacts.engines(),
                 NewtonIntegrator(damping=0)]
    O.dt = 1e-7
    while O.bodies[1].state.vel[2] < 0 or O.interactions.countReal():
        O.step()
    e.append([O.bodies[k].state.vel[2] for k in (0, 1)])
answer(e=e)
"""


@pytest.mark.yade
def test_a_contact_across_a_periodic_face_is_like_any_other(tmp_path):
    """Positions of 0.1 m cost 1e-17 m of an overlap of 1e-4 m."""
    inside, across = yade(tmp_path, "thornton", PERIODIC)["e"]
    assert inside[0] == pytest.approx(-inside[1], rel=1e-10) and 2 < inside[1] < 4
    assert across == pytest.approx(inside, rel=1e-9)


@pytest.mark.yade
def test_wrong_words_are_refused_with_the_right_ones(tmp_path):
    script = """
words = []
for call in (lambda: Contacts("thorton"), lambda: Contacts("thornton", plastic_ratio=2.0),
             lambda: Contacts("cavity", plastic_ratio=1.0),
             lambda: contacts.material("m", young_modulus=1e11, poisson_ratio=0.3, density=1e3),
             lambda: contacts.material("m", young_modulus=1e9, poisson_ratio=0.3, density=1e3, yield_pressure=1e9)):
    try:
        call()
        words.append("accepted")
    except (ValueError, TypeError) as error:
        words.append(str(error))
answer(words=words)
"""
    words = yade(tmp_path, "thornton", script)["words"]
    for found, expected in zip(
        words,
        (
            "hertz, thornton, johnson, cavity",
            "plastic_ratio",
            "cavity",
            "yield_pressure",
            "needs less than",
        ),
        strict=True,
    ):
        assert expected in found
