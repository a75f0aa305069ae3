// SPDX-License-Identifier: BSD-3-Clause
#ifndef SavedShape_h
#define SavedShape_h

class pqPropertyWidget;
class vtkSMProxy;

/// The result of Morph Mesh as a shape of Morph Shapes.
namespace SavedShape
{
/// Copies the filter of `widget`, as its panel has it, to a filter Shape1, Shape2 and so on. The
/// copy becomes the next shape of the Morph Shapes filter on the same mesh that was made last, or
/// the first shape of a new one. That is then applied, and active. So the filter itself can be
/// changed for the next shape, and a state file has all of them. One step for undo. If the filter
/// moves nothing once it is applied, there is no shape, and the panel has the reason.
void Save(pqPropertyWidget* widget);
/// Whether the filter's last execution has moved the mesh.
bool HasMotion(vtkSMProxy* filter);
}

#endif
