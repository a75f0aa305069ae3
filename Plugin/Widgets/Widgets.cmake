# SPDX-License-Identifier: BSD-3-Clause
# The code of this folder runs in ParaView's window alone, and needs its Qt, 5 or 6. Each class is
# one line below. Sets for paraview_add_plugin: widget_interfaces, widget_sources,
# widget_interface_sources, which ParaView makes, and widget_resources; and widget_libraries to
# link.
set(widget_interfaces)
set(widget_sources)
set(widget_interface_sources)
set(widget_resources) # icons, and the filters' places in the menu
set(widget_libraries)

macro (morph_add_client_class class)
  list(APPEND widget_interfaces ${widget_interface})
  list(APPEND widget_interface_sources ${widget_interface_source})
  list(APPEND widget_sources "Widgets/${class}.cxx" "Widgets/${class}.h")
endmacro ()

# A class that shows a property in the panel: its XML has panel_widget="<type>". Kind: WIDGET, or
# GROUP_WIDGET for a group of properties, or WIDGET_DECORATOR.
macro (morph_property_widget class type kind)
  paraview_plugin_add_property_widget(
    KIND       "${kind}"
    TYPE       "${type}"
    CLASS_NAME "${class}"
    INTERFACES widget_interface
    SOURCES    widget_interface_source)
  morph_add_client_class("${class}")
endmacro ()

# A class whose startup() is called once, when the plugin is loaded into the window.
macro (morph_auto_start class)
  paraview_plugin_add_auto_start(
    CLASS_NAME "${class}"
    INTERFACES widget_interface
    SOURCES    widget_interface_source)
  morph_add_client_class("${class}")
endmacro ()

# A group of actions, in the menu `place`.
macro (morph_action_group class place)
  paraview_plugin_add_action_group(
    CLASS_NAME "${class}"
    GROUP_NAME "${place}"
    INTERFACES widget_interface
    SOURCES    widget_interface_source)
  morph_add_client_class("${class}")
endmacro ()

if (PARAVIEW_USE_QT)
  morph_auto_start(ActiveColors)
  morph_auto_start(FirstColumns)
  morph_auto_start(FirstHit)
  morph_auto_start(FirstReader)
  morph_auto_start(QuietFilters)
  morph_auto_start(SeriesColors)
  morph_auto_start(StopButton)
  morph_auto_start(SurfaceMenu)
  morph_action_group(SaveCoordinates "MenuBar/File")
  morph_property_widget(ZoneList ZoneList WIDGET)
  morph_property_widget(SurfaceTable SurfaceTable GROUP_WIDGET)
  morph_property_widget(StatusLine StatusLine WIDGET)
  morph_property_widget(WholeNumber WholeNumber WIDGET)
  morph_property_widget(PanelLabel PanelLabel WIDGET_DECORATOR)
  morph_property_widget(Beside Beside WIDGET_DECORATOR)
  morph_property_widget(Fold Fold WIDGET_DECORATOR)
  morph_property_widget(ControlPointDrag ControlPointDrag WIDGET_DECORATOR)
  morph_property_widget(CopiedSelection CopiedSelection WIDGET_DECORATOR)
  morph_property_widget(StretchedColumns StretchedColumns WIDGET_DECORATOR)
  morph_property_widget(TakeBest TakeBest WIDGET_DECORATOR)
  morph_property_widget(TakeSelection TakeSelection WIDGET_DECORATOR)
  morph_property_widget(BoxDragDecorator BoxDrag WIDGET_DECORATOR)
  morph_property_widget(KnownResult KnownResult WIDGET_DECORATOR)
  morph_property_widget(OnlySurface OnlySurface WIDGET_DECORATOR)
  morph_property_widget(PresentDimension PresentDimension WIDGET_DECORATOR)
  morph_property_widget(ShapeSliders ShapeSliders WIDGET)
  if (separate_help)
    morph_auto_start(MorphHelp)
  endif ()
  list(APPEND widget_sources
    Widgets/BadCells.cxx Widgets/BadCells.h
    Widgets/Ancestor.h
    Widgets/BelowField.cxx Widgets/BelowField.h
    Widgets/BoxAboutCenter.cxx Widgets/BoxAboutCenter.h
    Widgets/FoldTitle.cxx Widgets/FoldTitle.h
    Widgets/Folds.cxx Widgets/Folds.h
    Widgets/HintedResults.cxx Widgets/HintedResults.h
    Widgets/LiveDrag.cxx Widgets/LiveDrag.h
    Widgets/MessageList.cxx Widgets/MessageList.h
    Widgets/MotionPreview.cxx Widgets/MotionPreview.h
    Widgets/PanelWords.cxx Widgets/PanelWords.h
    Widgets/QualityBar.cxx Widgets/QualityBar.h
    Widgets/SavedShape.cxx Widgets/SavedShape.h
    Widgets/SurfaceColors.cxx Widgets/SurfaceColors.h
    Widgets/SurfaceHighlight.cxx Widgets/SurfaceHighlight.h
    Widgets/TickedNames.cxx Widgets/TickedNames.h)
  set(widget_resources Widgets/MeshMorphing.qrc)
  set(widget_libraries ParaView::pqApplicationComponents VTK::InteractionWidgets)
endif ()
