import sys; sys.path[:0]=['tests','tests/engines']
import pathlib,tempfile,numpy as np
from test_passive import *
from lammps_walks import *
def table(cl,bed,mu=0.0,ns=(500,1000,2000,4000)):
    o=[]
    for n in ns:
        f=pathlib.Path(tempfile.mkdtemp()); w,e,l=walks_of_lammps(f,CLUSTERS[cl],BEDS[bed],n,mu)
        led=np.abs(w-e-l).max(0)/w.max(0)
        o.append('%d: fall10 %.1e fall0 %.1e led %.1e'%(n,falls(w,e,10).max(),falls(w,e).max(),led.max()))
    print(cl,bed,mu,' | '.join(o),flush=True)
for cl in CLUSTERS:
    for bed in BEDS: table(cl,bed)
