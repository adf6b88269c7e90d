import sys; sys.path[:0]=['tests','tests/engines']
import pathlib,tempfile,numpy as np
from test_plugin_compaction import *
for n in (3000,6000):
    w,e,p=walks(pathlib.Path(tempfile.mkdtemp()),n,count=20)
    r=w-e-p; k=np.abs(r).max(0)/w.max(); print(n,np.round(k*1e6,1))
    d=np.diff(r,axis=0)/w.max(); c=k.argmax(); i=np.abs(d[:,c]).argsort()[-8:]; print(c,[(int(j),float('%.1e'%d[j,c])) for j in sorted(i)], 'sum',d[:,c].sum())
a=cluster(pathlib.Path(tempfile.mkdtemp()),200); b=cluster(pathlib.Path(tempfile.mkdtemp()),200,ranks=2)
x=np.abs(a-b).max(axis=(1,2))/np.abs(a).max(); print('ranks',x.max(),np.flatnonzero(x>1e-12)[:5],[float('%.1e'%v) for v in x[195:240:4]])
F,l=exact(200); d=np.abs(a-F).max(axis=(1,2))/l; print('order',[float('%.1e'%v) for v in d[190:215]],d.argmax(),d.max())
