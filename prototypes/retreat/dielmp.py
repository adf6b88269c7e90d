import sys; sys.path[:0]=['bench','tests','tests/engines']
import pathlib,tempfile,numpy as np, lateral as L
known=L.finite_elements()
for mark in ("","_soft"):
    m=L.MATERIALS[mark]
    for D in L.DENSITIES["die"]:
        x=L.measures(L.die_between_walls(pathlib.Path(tempfile.mkdtemp()),m,D)); f=known.get(("die",m.E,m.nu,D,"z"),[np.nan]*5)
        print(mark,D,'law',np.round(x,4),'fe',np.round(f,4),flush=True)
for n in ("sc","hex","fcc"):
    m=L.MATERIALS[""]
    for D in L.DENSITIES[n]:
        for host in ("lammps","liggghts"):
            x=L.measures(L.lattice(pathlib.Path(tempfile.mkdtemp())/'a',host,n,m,D,'z')); f=known.get((n,m.E,m.nu,D,"z"),[np.nan]*5)
            print(n,D,host,'law',np.round(x,4),'fe',np.round(f,4),flush=True)
