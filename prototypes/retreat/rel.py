import sys; sys.path[:0]=['tests']
import numpy as np
from dense_lattices import *; from bed_lattices import *
cases=[(LATTICES[n],Material(E,nu,1.0),D) for n,E,nu,D,*_ in RELEASES]
for row,c in zip(RELEASES,released(cases,steps=STEPS)):
    print(row[0],row[1],row[2],row[3],[round(recovery(c,s)/row[-1][s],3) for s in (.75,.5,.25,.02)],flush=True)
